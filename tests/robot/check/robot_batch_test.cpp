// SPDX-License-Identifier: BSD-3-Clause
// Many configurations a call, one behind the other or shared out among threads: the verdicts and
// the errors of one at a time, whatever is remembered. That the answers are right, whatever the
// order: tests/soak/robots_test.cpp.

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

std::shared_ptr<const SphereTree> tree_of(const std::vector<Sphere>& spheres) {
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// Of one variable, on every instruction set.
void expect_free(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                 const std::vector<double>& path, const std::vector<std::uint8_t>& expected) {
  for (const InstructionSet set : instruction_sets()) {
    Checked checked(obstacle_checker(robot, obstacles, {.instructions = set}));
    EXPECT_EQ(checked.free(path, path.size()), expected);
  }
}

// Many small spheres in the way of a search make it run out of room; a block with numbers far out
// of range among others is answered as well.
TEST(RobotBatch, AnswersWhereThereIsTooMuchToRemember) {
  Random random(43);
  RobotModel robot("base");
  robot.add_link("arm", "base", wheel());
  robot.attach("arm", tree_of(random_spheres(random, 3000, 0.5, 0.01)));
  const std::vector<PlacedTree> obstacles = {
      {tree_of(random_spheres(random, 3000, 0.5, 1e-4)), Pose::from_translation({0.9, 0.0, 0.0})}};
  std::vector<double> path;
  std::vector<std::uint8_t> expected;
  for (int i = 0; i < 100; ++i) {
    path.push_back(0.001 * i + (i % 23 == 7 ? 628.3 : 0.0));
    expected.push_back(answer(robot, obstacles, std::span(path).last(1)) ? 0 : 1);
  }
  expect_free(robot, obstacles, path, expected);
}

// A sphere inside a shell of small spheres overlaps every inner sphere of the shell's tree, but
// only one sphere: more waits to be searched than there is room for, and nothing of it may be
// forgotten.
TEST(RobotBatch, NothingThatWaitsIsForgotten) {
  std::vector<Sphere> shell;
  constexpr int kCount = 5000;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount;
    const double turn = 2.399963229728653 * i;
    const double r = std::sqrt(1.0 - z * z);
    shell.push_back({{r * std::cos(turn), r * std::sin(turn), z}, 1e-3});
  }
  RobotModel robot("base");
  robot.add_link("slide", "base", sliding(0, 0, "", Eigen::Vector3d::UnitZ()));
  robot.attach("slide", tree_of({{{0, 0, 0}, 0.95}, {{2, 0, 0}, 0.01}}));
  shell.push_back({{0, 5, 0}, 3.9});  // only the sphere around all of the body overlaps it
  std::vector<double> path;
  for (int i = 0; i < 32; ++i) path.push_back(1e-4 * i);
  for (int at = 0; at < kCount; at += effort(97, 997)) {
    std::vector<Sphere> spheres = shell;
    if (at > 0) spheres[static_cast<std::size_t>(at)].radius = 0.06;
    SCOPED_TRACE(at);
    expect_free(robot, {{tree_of(spheres)}}, path,
                std::vector<std::uint8_t>(path.size(), at > 0 ? 0 : 1));
  }
}

// What robot_checker.cpp shares out.
constexpr std::size_t kPiece = 512;
constexpr std::size_t kFewestShared = 4096;

std::vector<RobotChecker::Scratch> scratches(const RobotChecker& checker, std::size_t count) {
  std::vector<RobotChecker::Scratch> result;
  for (std::size_t i = 0; i < count; ++i) result.emplace_back(checker);
  return result;
}

// In small steps, with a jump now and then.
std::vector<double> random_path(Random& random, const RobotModel& robot, std::size_t count) {
  std::vector<double> path;
  std::vector<double> at = random_configuration(random, robot, 3.2);
  for (std::size_t i = 0; i < count; ++i) {
    if (random.whole(0, 99) == 0) at = random_configuration(random, robot, 3.2);
    for (double& position : at) position += random.between(-0.01, 0.01);
    path.insert(path.end(), at.begin(), at.end());
  }
  return path;
}

TEST(RobotThreads, VerdictsAreThoseOfOneThread) {
  Random random(seeded(71));
  std::size_t hits = 0;
  std::size_t free = 0;
  for (int i = 0; i < scaled(40, 26); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.3);
    const auto variables = static_cast<std::size_t>(robot.variable_count());
    if (variables == 0) continue;
    RobotScene scene(robot, random_root(random, 1.0));
    for (const PlacedTree& tree : random_obstacles(random)) {
      scene.add(std::to_string(scene.obstacles().size()), tree.tree, tree.world_from_tree);
    }
    const RobotChecker checker = scene.snapshot({.enforce_limits = i % 2 == 0});
    // About the ends of pieces and of blocks, and anywhere; some are shared out, some are not.
    constexpr std::size_t kLongest = kFewestShared + 3 * kPiece;
    const std::size_t sizes[] = {0,
                                 17,
                                 kPiece + 1,
                                 kFewestShared - 1,
                                 kFewestShared,
                                 kFewestShared + kPiece - 3,
                                 kFewestShared + kPiece + 1,
                                 kFewestShared + random.index(kLongest - kFewestShared)};
    std::vector<double> path = random_path(random, robot, kLongest);
    for (std::size_t k = 0; k < path.size(); k += 50 * variables) path[k] *= 40.0;
    std::vector<std::uint8_t> expected;
    Checked one(checker);
    for (std::size_t k = 0; k < kLongest; ++k) {
      expected.push_back(one.free(std::span(path).subspan(k * variables, variables)) ? 1 : 0);
      (expected.back() == 0 ? hits : free) += 1;
    }
    std::vector<RobotChecker::Scratch> seven = scratches(checker, 7);
    for (const std::size_t size : sizes) {
      const auto configurations = std::span(path).first(size * variables);
      const std::vector<std::uint8_t> truth(expected.begin(),
                                            expected.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_EQ(one.free(configurations, size), truth) << i << ' ' << size;
      for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
        std::vector<std::uint8_t> verdicts(size, 2);
        checker.check_configs(configurations, std::span(seven).first(threads), verdicts);
        ASSERT_EQ(verdicts, truth) << i << ' ' << size << ' ' << threads;
      }
    }
  }
  EXPECT_GT(hits, static_cast<std::size_t>(effort(10000, 1000)));
  EXPECT_GT(free, static_cast<std::size_t>(effort(10000, 1000)));
}

// What is thrown is what one thread would meet first, whichever thread comes to which first.
TEST(RobotThreads, ErrorsAreThoseOfOneThread) {
  const RobotChecker checker = obstacle_checker(one_arm(sliding(0, 0), {0, 0, 0}, 0.05),
                                                {{one_sphere_tree({1, 0, 0}, 0.05)}});
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  constexpr double kTooFar = 1e17;
  const auto error_of = [&](const std::vector<double>& path, std::size_t threads) -> std::string {
    std::vector<RobotChecker::Scratch> some = scratches(checker, threads);
    std::vector<std::uint8_t> verdicts(path.size());
    try {
      if (threads == 0) {
        Checked(checker).free(path, path.size());
      } else {
        checker.check_configs(path, some, verdicts);
      }
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  std::vector<double> path(kFewestShared + 3 * kPiece - 5, 0.5);  // long enough to be shared out
  EXPECT_EQ(error_of(path, 3), "");
  std::set<std::string> errors;
  for (const std::size_t first : {std::size_t{3}, 3 * kPiece + 7, path.size() - 1}) {
    for (const auto& [at_first, later] : {std::pair(kNoNumber, kTooFar), {kTooFar, kNoNumber}}) {
      std::vector<double> bad = path;
      for (std::size_t i = first; i < bad.size(); i += kPiece) bad[i] = later;
      bad[first] = at_first;
      const std::string expected = error_of(bad, 0);
      EXPECT_NE(expected, "");
      errors.insert(expected);
      for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
        EXPECT_EQ(error_of(bad, threads), expected) << first << ' ' << threads;
      }
    }
  }
  EXPECT_EQ(errors.size(), 2U);
}

using Meshes = std::vector<std::shared_ptr<const CoveredMesh>>;

// Of all, of the robot alone, of the two obstacles alone, which are the last, of none.
Meshes some_of(const Meshes& meshes, int which) {
  Meshes some;
  if (which < 2) some.assign(meshes.begin(), meshes.end() - 2);
  if (which % 2 == 0) some.insert(some.end(), meshes.end() - 2, meshes.end());
  return some;
}

// Sometimes another query: of a block, a motion, or a clearance.
void query_in_between(Random& random, Checked& checked, const Configuration& at,
                      const Configuration& elsewhere) {
  switch (random.whole(0, 40)) {
    case 0:
      checked.free(elsewhere, 1);
      break;
    case 1:
      checked.edge(elsewhere, at, {.resolution = 0.05});
      break;
    case 2:
      checked.checker.within(at, random.between(0.0, 0.1), checked.scratch);
      break;
    default:
      break;
  }
}

// Along paths, with steps of any size, stops and jumps, what is remembered changes no answer:
// neither of those before, nor of a block or a motion that was requested in between.
TEST(RobotMemory, AnswersAlongAPathAsWithoutIt) {
  Random random(seeded(63));
  int hits = 0;
  int free = 0;
  int changes = 0;
  for (int i = 0; i < scaled(60, 10); ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 6), i % 2 == 1);
    ObstacleOptions options{.world_from_root = random_root(random, 1.0)};
    std::vector<std::shared_ptr<const CoveredMesh>> meshes;
    // What stands with the root would touch always or never.
    for (const Joint& joint : std::vector<Joint>(robot.joints())) {
      const Link& link = robot.links()[static_cast<std::size_t>(joint.child_link)];
      meshes.push_back(covered_tetrahedron(random, random.between(0.05, 0.4)));
      robot.attach(std::string(link.name), cover_of(meshes.back()));
    }
    std::vector<PlacedTree> obstacles;
    // Obstacles stand where links come to, and the paths begin there.
    const std::vector<double> home = random_configuration(random, robot, 3.2);
    std::vector<Pose> links;
    forward_kinematics(robot, home, links, options.world_from_root);
    for (int k = 0; k < 2; ++k) {
      meshes.push_back(covered_tetrahedron(random, random.between(0.05, 0.4)));
      const auto link =
          static_cast<std::size_t>(random.whole(1, static_cast<int>(robot.links().size()) - 1));
      obstacles.push_back(
          {cover_of(meshes.back()),
           Pose(random.quaternion(), links[link].translation() + random.point(0.5))});
    }
    const auto near_home = [&] { return moved(random_configuration(random, robot, 0.3), home); };
    options.meshes = some_of(meshes, i % 4);
    Checked remembers(obstacle_checker(robot, obstacles, options));
    std::vector<double> at = near_home();
    std::vector<double> heading = random_configuration(random, robot, 1.0);
    double step = 1e-2;
    bool before = false;
    for (int k = 0; k < 1500; ++k) {
      if (random.whole(0, 60) == 0) heading = random_configuration(random, robot, 1.0);
      if (random.whole(0, 90) == 0) step = std::pow(10.0, random.between(-6.0, -1.3));
      if (random.whole(0, 150) == 0) at = near_home();
      if (random.whole(0, 20) != 0) {
        for (std::size_t v = 0; v < at.size(); ++v) at[v] += step * heading[v];
      }
      const bool expected = Checked(remembers.checker).free(at);
      ASSERT_EQ(remembers.free(at), expected) << i << ' ' << k;
      query_in_between(random, remembers, at, near_home());
      (expected ? free : hits) += 1;
      changes += k > 0 && before != expected;
      before = expected;
    }
  }
  EXPECT_GT(hits, effort(3000, 300));
  EXPECT_GT(free, effort(3000, 300));
  EXPECT_GT(changes, effort(100, 10));
}

}  // namespace
}  // namespace spherule::test
