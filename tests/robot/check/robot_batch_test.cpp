// SPDX-License-Identifier: BSD-3-Clause
// Many configurations a call: the same answers as one by one, whatever the order.

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "spheretree/build.h"
#include "tests/collide/trees.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// Configurations one behind the other.
struct Path {
  std::vector<double> positions{};
  std::size_t variables = 0;

  std::size_t size() const { return variables == 0 ? 0 : positions.size() / variables; }
  std::span<const double> operator[](std::size_t i) const {
    return std::span(positions).subspan(i * variables, variables);
  }
  void add(const std::vector<double>& configuration) {
    positions.insert(positions.end(), configuration.begin(), configuration.end());
  }
};

// From configuration to configuration in steps of about `step`, with as much noise; a step of zero
// stands for configurations that have nothing to do with each other.
Path random_path(SceneRandom& random, const RobotModel& robot, std::size_t count, double step) {
  Path path{.variables = static_cast<std::size_t>(robot.variable_count())};
  std::vector<double> at = random_configuration(random, robot, 3.2);
  std::vector<double> direction = random_configuration(random, robot, step);
  for (std::size_t i = 0; i < count; ++i) {
    if (random.whole(0, 30) == 0) direction = random_configuration(random, robot, step);
    if (step == 0.0) at = random_configuration(random, robot, 3.2);
    for (std::size_t k = 0; k < at.size(); ++k) {
      at[k] += direction[k] + 0.1 * step * random.uniform(-1.0, 1.0);
    }
    path.add(at);
  }
  return path;
}

std::vector<std::uint8_t> verdicts(const ObstacleChecker& checker, const Path& path,
                                   RobotChecker::Scratch& scratch) {
  std::vector<std::uint8_t> result(path.size());
  checker.collides(path.positions, scratch, result);
  return result;
}

// The same by the exact queries.
std::vector<std::uint8_t> answers(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                                  const Path& path, const ObstacleOptions& options) {
  std::vector<std::uint8_t> result;
  for (std::size_t k = 0; k < path.size(); ++k) {
    result.push_back(answer(robot, obstacles, path[k], options) ? 1 : 0);
  }
  return result;
}

// How many of the verdicts so far say collision and free.
struct Count {
  std::ptrdiff_t hits = 0;
  std::ptrdiff_t free = 0;

  void add(const std::vector<std::uint8_t>& verdicts) {
    const std::ptrdiff_t ones = std::count(verdicts.begin(), verdicts.end(), 1);
    hits += ones;
    free += static_cast<std::ptrdiff_t>(verdicts.size()) - ones;
  }
};

TEST(RobotBatch, AnswersAsTheExactQueriesDo) {
  SceneRandom random(41);
  Count count;
  for (int i = 0; i < effort(400, 20); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.3);
    if (robot.variable_count() == 0) continue;
    const std::vector<PlacedTree> obstacles = random_obstacles(random);
    ObstacleOptions options{.world_from_root = i % 2 == 0 ? Pose() : random_root(random, 3.0)};
    std::vector<Path> paths;
    for (const double step : {1e-3, 1e-2, 0.1, 0.0, 1e-4}) {
      const auto length = static_cast<std::size_t>(random.whole(1, effort(90, 30)));
      paths.push_back(random_path(random, robot, length, step));
    }
    std::vector<std::vector<std::uint8_t>> expected;
    for (const Path& path : paths) {
      expected.push_back(answers(robot, obstacles, path, options));
      count.add(expected.back());
    }
    for (const InstructionSet set : instruction_sets()) {
      options.instructions = set;
      const ObstacleChecker checker(robot, obstacles, options);
      RobotChecker::Scratch scratch(checker);  // one for all paths: what it remembers is no matter
      for (std::size_t k = 0; k < paths.size(); ++k) {
        ASSERT_EQ(verdicts(checker, paths[k], scratch), expected[k]) << i << ' ' << k;
      }
    }
  }
  EXPECT_GT(count.hits, effort(2000, 40));
  EXPECT_GT(count.free, effort(2000, 40));
}

// A sphere stands where one of the robot is in the middle of a path, at a distance that single
// precision cannot tell from contact, or can only just, or that is about as long as a step.
TEST(RobotBatch, AnswersAsTheExactQueriesDoAtContact) {
  SceneRandom random(42);
  Count count;
  for (int i = 0; i < effort(1500, 100); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.3);
    const Pose root = i % 2 == 0 ? Pose() : random_root(random, 100.0);
    const double step = std::pow(10.0, random.uniform(-9.0, -2.0));
    const auto length = static_cast<std::size_t>(random.whole(1, 40));
    const Path path = random_path(random, robot, length, step);
    if (path.size() == 0) continue;
    std::vector<Pose> world_from_link;
    forward_kinematics(robot, path[random.bits() % path.size()], world_from_link, root);
    const std::optional<Sphere> sphere = random_sphere_of(random, robot, world_from_link);
    if (!sphere) continue;
    const double gap =
        (random.whole(0, 1) == 0 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-12.0, -2.0));
    const Eigen::Vector3d center =
        sphere->center + (sphere->radius + 0.1 + gap) * random.point(1.0).normalized();
    const std::vector<PlacedTree> obstacles = {{one_sphere_tree(center, 0.1), Pose()}};
    ObstacleOptions options{.world_from_root = root};
    const std::vector<std::uint8_t> expected = answers(robot, obstacles, path, options);
    count.add(expected);
    for (const InstructionSet set : instruction_sets()) {
      options.instructions = set;
      const ObstacleChecker checker(robot, obstacles, options);
      RobotChecker::Scratch scratch(checker);
      ASSERT_EQ(verdicts(checker, path, scratch), expected) << i << ' ' << gap << ' ' << step;
    }
  }
  EXPECT_GT(count.hits, effort(2000, 40));
  EXPECT_GT(count.free, effort(2000, 40));
}

// Many small spheres in the way of a search make it run out of room; a block with numbers far out
// of range among others is answered as well.
TEST(RobotBatch, AnswersWhereThereIsTooMuchToRemember) {
  SceneRandom random(43);
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", std::make_shared<const SphereTree>(
                          build_tree(random_spheres(random, 3000, 0.5, 0.01))));
  const std::vector<PlacedTree> obstacles = {
      {std::make_shared<const SphereTree>(build_tree(random_spheres(random, 3000, 0.5, 1e-4))),
       Pose::from_translation({0.9, 0.0, 0.0})}};
  Path path{.variables = 1};
  for (int i = 0; i < 100; ++i) path.add({0.001 * i + (i % 23 == 7 ? 628.3 : 0.0)});
  const std::vector<std::uint8_t> expected = answers(robot, obstacles, path, {});
  for (const InstructionSet set : instruction_sets()) {
    const ObstacleChecker checker(robot, obstacles, {.instructions = set});
    RobotChecker::Scratch scratch(checker);
    EXPECT_EQ(verdicts(checker, path, scratch), expected);
  }
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
  robot.add_link("slide", "base", {.name = "slide", .type = JointType::kPrismatic});
  robot.attach("slide", std::make_shared<const SphereTree>(
                            build_tree(std::vector<Sphere>{{{0, 0, 0}, 0.95}, {{2, 0, 0}, 0.01}})));
  shell.push_back({{0, 5, 0}, 3.9});  // only the sphere around all of the body overlaps it
  Path path{.variables = 1};
  for (int i = 0; i < 32; ++i) path.add({1e-4 * i});
  for (int at = 0; at < kCount; at += effort(97, 997)) {
    std::vector<Sphere> spheres = shell;
    if (at > 0) spheres[static_cast<std::size_t>(at)].radius = 0.06;
    const std::vector<PlacedTree> obstacles = {
        {std::make_shared<const SphereTree>(build_tree(spheres)), Pose()}};
    for (const InstructionSet set : instruction_sets()) {
      const ObstacleChecker checker(robot, obstacles, {.instructions = set});
      RobotChecker::Scratch scratch(checker);
      const std::vector<std::uint8_t> expected(path.size(), at > 0 ? 1 : 0);
      EXPECT_EQ(verdicts(checker, path, scratch), expected) << at;
    }
  }
}

TEST(RobotBatch, RefusesBadInput) {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  const ObstacleChecker checker(robot, {{one_sphere_tree({0, 1, 0}, 0.1), Pose()}});
  RobotChecker::Scratch scratch(checker);
  std::vector<std::uint8_t> two(2);
  EXPECT_THROW(checker.collides(std::vector<double>{0.0}, scratch, two), Error);
  EXPECT_THROW(checker.collides(std::vector<double>{0.0, 0.0, 0.0}, scratch, two), Error);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(checker.collides(std::vector<double>{0.0, bad}, scratch, two), Error) << bad;
  }
  checker.collides({}, scratch, {});
  checker.collides(std::vector<double>{0.0, 1.5707963}, scratch, two);
  EXPECT_EQ(two, (std::vector<std::uint8_t>{0, 1}));
}

}  // namespace
}  // namespace spherule::test
