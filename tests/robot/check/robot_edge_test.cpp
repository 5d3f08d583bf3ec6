// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "spheretree/build.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/check/edge_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Straight motions in joint space, against many configurations on them.

namespace spherule::test {
namespace {

void expect_true(const ObstacleChecker& checker, const std::vector<double>& from,
                 const std::vector<double>& to, const EdgeResult& result, int steps) {
  RobotChecker::Scratch scratch(checker);
  const auto hits = [&](const std::vector<double>& at) { return checker.collides(at, scratch); };
  expect_so(hits, from, to, result, steps);
}

// Motions that follow each other in steps of any size, beside what was found near: what the scratch
// remembers proves many of them, and none that is not free.
TEST(RobotEdge, WhatIsProvedFreeAlongAPathIsFree) {
  Random random(seeded(55));
  int free = 0;
  int remembered = 0;
  int hits = 0;
  int unknown = 0;
  for (int i = 0; i < scaled(300, 20); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.2);
    if (robot.variable_count() == 0) continue;
    std::vector<double> at = random_configuration(random, robot, 3.0);
    std::vector<Pose> links;
    forward_kinematics(robot, at, links);
    const std::optional<Sphere> near = random_sphere_of(random, robot, links);
    if (!near) continue;
    // A sphere that the path begins beside.
    const double gap = std::pow(10.0, random.between(-6.0, -1.0));
    const Eigen::Vector3d center =
        near->center + (near->radius + 0.05 + gap) * random.point(1.0).normalized();
    const ObstacleChecker checker(robot, {{one_sphere_tree(center, 0.05), Pose()}});
    RobotChecker::Scratch scratch(checker);
    double step = 0.0;
    std::vector<double> heading;
    for (int k = 0; k < 60; ++k) {
      if (k % 15 == 0) {
        step = std::pow(10.0, random.between(-5.0, -1.5));
        heading = random_configuration(random, robot, step);
      }
      std::vector<double> to = at;
      for (std::size_t v = 0; v < to.size(); ++v) {
        to[v] += heading[v] + 0.1 * step * random.between(-1.0, 1.0);
      }
      const EdgeResult result = checker.check_edge(at, to, scratch, {.first = k % 7 == 0});
      expect_true(checker, at, to, result, effort(100, 30));
      if (HasFailure()) return;
      (result.verdict == Verdict::kFree        ? free
       : result.verdict == Verdict::kCollision ? hits
                                               : unknown) += 1;
      remembered += result.configurations == 1 ? 1 : 0;
      at = to;
    }
  }
  EXPECT_GT(free, effort(3000, 200));
  EXPECT_GT(remembered, effort(2000, 100));
  EXPECT_GT(hits, effort(1000, 50));
  EXPECT_LT(unknown, (free + hits) / 20);
}

// A long arm with a small sphere at its end.
RobotModel long_arm() {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", one_sphere_tree({10, 0, 0}, 1e-3));
  return robot;
}

TEST(RobotEdge, NothingIsPassedThrough) {
  Random random(seeded(52));
  const RobotModel robot = long_arm();
  for (int i = 0; i < scaled(500, 50); ++i) {
    const double angle = random.between(-40.0, 40.0);
    const double size = std::pow(10.0, random.between(-6.0, -2.0));
    // Just in the way, or just beside it.
    const double beside =
        (1e-3 + size) * (random.whole(0, 1) == 0 ? random.between(0.0, 0.999) : 1.3);
    const Eigen::Vector3d center(10.0 * std::cos(angle), 10.0 * std::sin(angle), beside);
    const ObstacleChecker checker(robot, {{one_sphere_tree(center, size), Pose()}});
    RobotChecker::Scratch scratch(checker);
    const double before = random.between(0.1, 50.0);
    const double after = random.between(0.1, 50.0);
    const std::vector<double> from = {angle - before};
    const std::vector<double> to = {angle + after};
    const EdgeRequest request{.resolution = 1e-4, .first = i % 2 == 0};
    const EdgeResult result = checker.check_edge(from, to, scratch, request);
    const bool intersects = beside < 1e-3 + size;
    EXPECT_EQ(result.verdict == Verdict::kFree, !intersects) << i << ' ' << size;
    EXPECT_LE(result.free_until, intersects ? before / (before + after) : 1.0);
    expect_true(checker, from, to, result, 100);
    if (intersects && request.first) {
      const double turns = std::floor(before / (2.0 * 3.14159265358979323846));
      const double met = (before - turns * 2.0 * 3.14159265358979323846) / (before + after);
      EXPECT_NEAR(result.free_until, met, 1e-3 / (before + after)) << "the first of many turns";
    }
  }
}

// A shift and a turn of bodies on bodies, at a wall of spheres with no gap.
TEST(RobotEdge, AWallIsNotPassed) {
  Random random(seeded(53));
  std::vector<Sphere> wall;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) wall.push_back({{1.0, 0.02 * i, 0.02 * k}, 0.015});
  }
  const std::vector<PlacedTree> obstacles = {
      {std::make_shared<const SphereTree>(build_tree(wall)), Pose()}};
  for (int i = 0; i < scaled(200, 20); ++i) {
    RobotModel robot("base");
    robot.add_link("slide", "base",
                   {.name = "slide", .type = JointType::kPrismatic, .axis = {1, 0, 0}});
    robot.add_link("drill", "slide",
                   {.name = "drill", .type = JointType::kRevolute, .axis = {1, 0, 0}});
    const Eigen::Vector3d offset(0.0, random.between(0.0, 0.2), random.between(0.0, 0.2));
    robot.attach("drill", one_sphere_tree(offset, 1e-3));
    const ObstacleChecker checker(robot, obstacles);
    RobotChecker::Scratch scratch(checker);
    const std::vector<double> from = {random.between(-60.0, 0.9), random.between(-9.0, 9.0)};
    const std::vector<double> to = {random.between(1.1, 60.0), random.between(-9.0, 9.0)};
    const EdgeResult result = checker.check_edge(from, to, scratch, {.first = true});
    EXPECT_NE(result.verdict, Verdict::kFree);
    expect_true(checker, from, to, result, 300);
    const double reached = (1.0 - result.free_until) * from[0] + result.free_until * to[0];
    EXPECT_NEAR(reached, 0.99, 0.01) << "as far as the wall, and not further";
  }
}

TEST(RobotEdge, PassesCloseAtAFineResolution) {
  const RobotModel robot = long_arm();
  // Beside the way of the arm's end, at a gap of 2e-4.
  const ObstacleChecker checker(robot, {{one_sphere_tree({0, 10, 0.0022}, 1e-3), Pose()}});
  RobotChecker::Scratch scratch(checker);
  const auto verdict = [&](double resolution) {
    return checker
        .check_edge(std::vector<double>{0.0}, std::vector<double>{3.0}, scratch,
                    {.resolution = resolution})
        .verdict;
  };
  EXPECT_NE(verdict(1e-2), Verdict::kCollision);
  EXPECT_EQ(verdict(1e-4), Verdict::kFree);
}

// Halved as often as can be, near the start and then ever closer to a contact.
TEST(RobotEdge, EndsAtAnyResolution) {
  const RobotModel robot = long_arm();
  for (const double angle : {0.5, 1e-9, 1e-15, 3.0}) {
    const Eigen::Vector3d center(10.0 * std::cos(angle + 2e-4), 10.0 * std::sin(angle + 2e-4), 0.0);
    const ObstacleChecker checker(robot, {{one_sphere_tree(center, 1e-3), Pose()}});
    RobotChecker::Scratch scratch(checker);
    for (const double resolution : {1e-12, 1e-300, std::numeric_limits<double>::denorm_min()}) {
      const std::vector<double> from = {0.0};
      const std::vector<double> to = {3.0};
      const EdgeResult result =
          checker.check_edge(from, to, scratch, {.resolution = resolution, .first = true});
      EXPECT_NE(result.verdict, Verdict::kFree);
      EXPECT_NEAR(result.free_until * 3.0, angle, 1e-6);
      EXPECT_LE(result.free_until * 3.0, angle + 1e-9);
    }
  }
}

// Past a sphere that is touched at the closest approach only: free up to where the resolution ends.
TEST(RobotEdge, IsFreeUpToWhereItGrazes) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .axis = {1, 0, 0}});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 1.0));
  const ObstacleChecker checker(robot, {{one_sphere_tree({0, 0, 2}, 1.0), Pose()}});
  RobotChecker::Scratch scratch(checker);
  for (const double resolution : {1e-2, 1e-3, 1e-4}) {
    const EdgeResult result =
        checker.check_edge(std::vector<double>{-1.0}, std::vector<double>{2.0}, scratch,
                           {.resolution = resolution, .first = true});
    EXPECT_NE(result.verdict, Verdict::kFree);
    EXPECT_NEAR(3.0 * result.free_until, 1.0, 3.0 * resolution);
  }
}

TEST(RobotEdge, TakesAnyContactUnlessAskedForTheFirst) {
  const RobotModel robot = long_arm();
  const ObstacleChecker checker(
      robot, {{one_sphere_tree({10.0 * std::cos(0.5), 10.0 * std::sin(0.5), 0}, 0.01), Pose()},
              {one_sphere_tree({10.0 * std::cos(1.5), 10.0 * std::sin(1.5), 0}, 0.01), Pose()}});
  RobotChecker::Scratch scratch(checker);
  const std::vector<double> from = {0.0};
  const std::vector<double> to = {3.0};
  const EdgeResult any = checker.check_edge(from, to, scratch);
  EXPECT_EQ(any.verdict, Verdict::kCollision);
  const EdgeResult first = checker.check_edge(from, to, scratch, {.first = true});
  EXPECT_EQ(first.verdict, Verdict::kCollision);
  EXPECT_NEAR(first.contact_at, 0.5 / 3.0, 1e-3);
  EXPECT_NEAR(first.free_until, (0.5 - 0.0011) / 3.0, 1e-4);
  EXPECT_LE(any.configurations, first.configurations);
}

TEST(RobotEdge, BudgetsAndEnds) {
  const RobotModel robot = long_arm();
  const ObstacleChecker checker(robot, {{one_sphere_tree({0, 10, 0.0022}, 1e-3), Pose()}});
  RobotChecker::Scratch scratch(checker);
  const std::vector<double> from = {0.0};
  const std::vector<double> to = {3.0};
  for (const std::uint64_t budget : {0U, 1U, 7U}) {
    const EdgeResult result = checker.check_edge(from, to, scratch, {.max_configurations = budget});
    EXPECT_EQ(result.verdict, Verdict::kUnknown);
    EXPECT_LE(result.configurations, budget);
    expect_true(checker, from, to, result, 100);
  }
  // A contact that was found counts, however short the budget for what lies before it.
  const ObstacleChecker met(robot, {{one_sphere_tree({0, 10, 0}, 1e-3), Pose()}});
  RobotChecker::Scratch third(met);
  const EdgeRequest all{.resolution = 1e-9, .first = true};
  const std::uint64_t needed = met.check_edge(from, to, third, all).configurations;
  for (std::uint64_t budget = 0; budget < needed; ++budget) {
    EdgeRequest request = all;
    request.max_configurations = budget;
    const EdgeResult result = met.check_edge(from, to, third, request);
    EXPECT_LE(result.configurations, budget);
    EXPECT_EQ(result.verdict == Verdict::kCollision, result.contact_at <= 1.0);
    expect_true(met, from, to, result, 10);
  }
  EXPECT_EQ(checker.check_edge(from, from, scratch).verdict, Verdict::kFree);
  const ObstacleChecker touched(robot, {{one_sphere_tree({10, 0, 0}, 1e-3), Pose()}});
  RobotChecker::Scratch other(touched);
  const EdgeResult at_once = touched.check_edge(from, to, other, {.first = true});
  EXPECT_EQ(at_once.verdict, Verdict::kCollision);
  EXPECT_EQ(at_once.free_until, 0.0);
  EXPECT_EQ(touched.check_edge(from, from, other).verdict, Verdict::kCollision);
  const EdgeResult backwards = touched.check_edge(to, from, other, {.first = true});
  EXPECT_EQ(backwards.verdict, Verdict::kCollision);
  EXPECT_GT(backwards.free_until, 0.999);
}

TEST(RobotEdge, RefusesBadInput) {
  const ObstacleChecker checker(long_arm(), {{one_sphere_tree({0, 10, 0}, 1e-3), Pose()}});
  RobotChecker::Scratch scratch(checker);
  const std::vector<double> good = {0.0};
  RobotModel touching = long_arm();
  touching.attach("base", one_sphere_tree({0, 10, 0}, 1e-3));
  const ObstacleChecker standing(touching, {{one_sphere_tree({0, 10, 0}, 1e-3), Pose()}});
  RobotChecker::Scratch other(standing);
  EXPECT_EQ(standing.check_edge(good, good, other).verdict, Verdict::kCollision);
  for (const std::vector<double>& bad : {std::vector<double>{},
                                         {0.0, 0.0},
                                         {101.0},
                                         {std::numeric_limits<double>::quiet_NaN()},
                                         {std::numeric_limits<double>::infinity()}}) {
    EXPECT_THROW(checker.check_edge(bad, good, scratch), Error);
    EXPECT_THROW(checker.check_edge(good, bad, scratch), Error);
  }
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(checker.check_edge(good, good, scratch, {.resolution = bad}), Error);
    EXPECT_THROW(standing.check_edge(good, good, other, {.resolution = bad}), Error);
  }
}

// A checker keeps nothing of what stood in a tree or a mesh before it was assigned to, although the
// robot keeps what was computed of it for the next one.
TEST(RobotEdge, WhatWasAssignedToAnObstacleCounts) {
  RobotModel robot("base");
  robot.add_link("arm", "base",
                 {.name = "turn", .type = JointType::kRevolute, .lower = -3.0, .upper = 3.0});
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  const auto mesh_at = [](double x) {
    return TriangleMesh{{{x, 0, 0}, {x + 0.1, 0, 0}, {x, 0.1, 0}, {x, 0, 0.1}},
                        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  };
  const auto tree = std::make_shared<SphereTree>(*one_sphere_tree({9, 0, 0}, 0.1));
  const auto mesh = std::make_shared<SolidMesh>(mesh_at(9.0));
  RobotScene of_tree(robot);
  of_tree.add("post", std::shared_ptr<const SphereTree>(tree));
  of_tree.attach("tool", "arm", one_sphere_tree({1.5, 0, 0}, 0.1));
  RobotScene of_mesh = of_tree;
  of_mesh.remove("post");
  of_mesh.add("post", std::shared_ptr<const SolidMesh>(mesh));
  const auto verdicts = [&] {
    std::vector<Verdict> result;
    for (const RobotScene* scene : {&of_tree, &of_mesh}) {
      const RobotChecker checker = scene->snapshot();
      RobotChecker::Scratch scratch(checker);
      result.push_back(checker.check_edge(std::vector{-1.0}, std::vector{1.0}, scratch).verdict);
    }
    return result;
  };
  EXPECT_EQ(verdicts(), std::vector(2, Verdict::kFree));
  *tree = refit(std::move(*tree), std::vector<Sphere>{{{1, 0, 0}, 0.1}});
  *mesh = SolidMesh(mesh_at(1.0));
  EXPECT_EQ(verdicts(), std::vector(2, Verdict::kCollision));
}

// Spheres around right triangles do not tell where the right angle is, on which it may depend
// whether a surface is closed.
TEST(RobotEdge, TheInsideOfWhatWasAssignedToAnObstacleCounts) {
  RobotModel robot("base");
  robot.add_link("arm", "base",
                 {.name = "turn", .type = JointType::kRevolute, .lower = -3.0, .upper = 3.0});
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  const TriangleMesh closed = box_mesh(Eigen::Vector3d::Constant(-8), Eigen::Vector3d::Constant(8));
  TriangleMesh open = closed;
  Eigen::Vector3i& triangle = open.triangles.front();
  const auto corner = [&](int k) { return closed.vertices[static_cast<std::size_t>(triangle[k])]; };
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d middle = 0.5 * (corner((k + 1) % 3) + corner((k + 2) % 3));
    if ((corner(k) - middle).norm() > 1.01 * (corner((k + 1) % 3) - middle).norm()) continue;
    open.vertices.push_back(0.5 * (corner(k) + middle));
    triangle[k] = static_cast<int>(open.vertices.size()) - 1;
    break;
  }
  const auto mesh = std::make_shared<SolidMesh>(open);
  const auto spheres_of = [](const SolidMesh& solid) {
    const auto spheres = solid.mesh().tree().spheres();
    return std::vector<Sphere>(spheres.begin(), spheres.end());
  };
  ASSERT_EQ(spheres_of(*mesh), spheres_of(SolidMesh(closed)));
  RobotScene scene(robot);
  scene.add("shell", std::shared_ptr<const SolidMesh>(mesh));
  const auto verdict = [&] {
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    return checker.check_edge(std::vector{-1.0}, std::vector{1.0}, scratch).verdict;
  };
  EXPECT_EQ(verdict(), Verdict::kFree);
  *mesh = SolidMesh(closed);
  EXPECT_EQ(verdict(), Verdict::kCollision);
}

}  // namespace
}  // namespace spherule::test

// Motions on which continuous joints turn the shorter way, against many configurations on the way
// that std::remainder() finds, and against where contacts are known by hand.

namespace spherule::test::robot_shortest_edge_test {
namespace {

constexpr double kPi = std::numbers::pi;
using Configuration = std::vector<double>;

EdgeRequest by(ContinuousMotion continuous) {
  return {.resolution = 1e-3, .first = true, .continuous = continuous};
}

// A sphere that a continuous joint swings about the base, and one that stands at an angle.
RobotChecker swing_and_post(double angle) {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "swing", .type = JointType::kContinuous});
  robot.attach("arm", one_sphere_tree({1.0, 0.0, 0.0}, 0.01));
  RobotScene scene(robot);
  scene.add("post", one_sphere_tree({std::cos(angle), std::sin(angle), 0.0}, 0.01));
  return scene.snapshot();
}

TEST(RobotShortestEdge, TheWayThatIsStatedIsProved) {
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  const auto verdict = [&](double angle, ContinuousMotion continuous) {
    const RobotChecker checker = swing_and_post(angle);
    RobotChecker::Scratch scratch(checker);
    return checker.check_edge(from, to, scratch, by(continuous)).verdict;
  };
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kAsGiven), Verdict::kCollision);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kAsGiven), Verdict::kFree);
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kShortest), Verdict::kFree);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kShortest), Verdict::kCollision);
  const RobotChecker checker = swing_and_post(0.0);
  EXPECT_EQ(checker.configuration_on_edge(from, to, 0.5), Configuration{0.0});
  EXPECT_NEAR(checker.configuration_on_edge(from, to, 0.5, ContinuousMotion::kShortest)[0], kPi,
              1e-14);
  EXPECT_THROW(checker.configuration_on_edge(from, to, std::numeric_limits<double>::infinity()),
               Error);
  EXPECT_THROW(checker.configuration_on_edge({}, to, 0.5), Error);
  RobotChecker::Scratch scratch(checker);
  EXPECT_EQ(checker.check_edge(from, to, scratch).verdict, Verdict::kCollision) << "by default";
  EXPECT_NEAR(checker.measure_edge(from, to, scratch), 0.5, 0.01);
  EXPECT_EQ(checker.measure_edge(from, to, scratch, 1e-3, ContinuousMotion::kShortest), 1.0);
  std::vector<RobotChecker::Scratch> scratches;
  scratches.emplace_back(checker);
  const std::vector<EdgeResult> edges =
      checker.check_edges(Configuration{3.0, -3.0, 1.0}, Configuration{-3.0, 3.0, -1.0}, scratches,
                          by(ContinuousMotion::kShortest));
  EXPECT_EQ(edges[0].verdict, Verdict::kFree);
  EXPECT_EQ(edges[1].verdict, Verdict::kFree);
  EXPECT_EQ(edges[2].verdict, Verdict::kCollision);
  EXPECT_NEAR(edges[2].contact_at, 0.5, 0.02);
}

// An arm of two continuous joints, the second of which a third one follows, and a prismatic one,
// among small spheres.
RobotChecker random_arm(Random& random) {
  RobotModel robot("base");
  const Pose shoulder = Pose::from_translation({0.6, 0.0, 0.0});
  robot.add_link("upper", "base",
                 {.name = "swing", .type = JointType::kContinuous, .axis = {0.1, 0.2, 1.0}});
  robot.add_link("lower", "upper",
                 {.name = "turn",
                  .type = JointType::kContinuous,
                  .parent_from_joint = shoulder,
                  .axis = {0.3, 1.0, 0.2}});
  robot.add_link("wheel", "lower",
                 {.name = "wheel",
                  .type = JointType::kContinuous,
                  .parent_from_joint = shoulder,
                  .axis = {1.0, 0.0, 0.5}});
  robot.add_link("slider", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -9.0, .upper = 9.0});
  robot.mimic("wheel", "turn", static_cast<double>(random.whole(-3, 3)), random.between(-1.0, 1.0));
  for (const char* link : {"upper", "lower", "wheel"}) {
    robot.attach(link, one_sphere_tree({0.5, 0.0, 0.1}, 0.04));
  }
  robot.attach("slider", one_sphere_tree({0.4, 0.4, 0.4}, 0.04));
  RobotScene scene(robot);
  for (int i = 0; i < 8; ++i) {
    scene.add("post" + std::to_string(i),
              one_sphere_tree(
                  {random.between(-1.5, 1.5), random.between(-1.5, 1.5), random.between(-1.0, 1.0)},
                  0.05));
  }
  return scene.snapshot();
}

TEST(RobotShortestEdge, WhatIsProvedFreeIsFree) {
  Random random(seeded(91));
  int free = 0;
  int hits = 0;
  int other_way = 0;
  for (int n = 0; n < scaled(300, 40); ++n) {
    const RobotChecker checker = random_arm(random);
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < 4; ++i) {
      const double size = i == 0 ? 90.0 : 4.0;
      const Configuration from = {random.between(-size, size), random.between(-4.0, 4.0),
                                  random.between(-0.5, 0.5)};
      const Configuration to = {random.between(-size, size), random.between(-4.0, 4.0),
                                random.between(-0.5, 0.5)};
      Configuration end = to;
      for (std::size_t k = 0; k < 2; ++k) {
        end[k] = from[k] + std::remainder(to[k] - from[k], 2.0 * kPi);
      }
      other_way += std::abs(end[0] - to[0]) > 1.0 || std::abs(end[1] - to[1]) > 1.0 ? 1 : 0;
      const EdgeResult result =
          checker.check_edge(from, to, scratch, by(ContinuousMotion::kShortest));
      free += result.verdict == Verdict::kFree ? 1 : 0;
      hits += result.verdict == Verdict::kCollision ? 1 : 0;
      const auto touches = [&](const Configuration& at) {
        return !checker.check_config(at, scratch);
      };
      if (result.verdict != Verdict::kCollision) {
        expect_so(touches, from, end, result, effort(500, 100));
        continue;
      }
      // The contact is one of rounding only, and the ways are not the same to the last digit.
      EdgeResult before = result;
      before.verdict = Verdict::kUnknown;
      before.contact_at = std::numeric_limits<double>::infinity();
      expect_so(touches, from, end, before, effort(500, 100));
      const EdgeResult other = checker.check_edge(from, end, scratch, by({}));
      EXPECT_NEAR(other.contact_at, result.contact_at, 1e-6);
    }
  }
  EXPECT_GT(free, effort(200, 25));
  EXPECT_GT(hits, effort(80, 4));
  EXPECT_GT(other_way, effort(400, 50));
}

TEST(RobotShortestEdge, RefusesWhatCannotBeSo) {
  RobotModel robot("base");
  robot.add_link("wheel", "base", {.name = "lead", .type = JointType::kContinuous});
  robot.add_link("arm", "wheel",
                 {.name = "follow", .type = JointType::kContinuous, .axis = {0, 1, 0}});
  robot.mimic("follow", "lead", 0.5);
  const RobotChecker checker = RobotScene(robot).snapshot();
  RobotChecker::Scratch scratch(checker);
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  EXPECT_NO_THROW(checker.check_edge(from, to, scratch));
  try {
    checker.check_edge(from, to, scratch, by(ContinuousMotion::kShortest));
    ADD_FAILURE() << "is not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "joint follow");
  }
  // The shorter way leads beyond what is proved.
  const RobotChecker swing = swing_and_post(0.0);
  RobotChecker::Scratch other(swing);
  EXPECT_THROW(swing.check_edge(Configuration{99.9}, Configuration{89.33}, other,
                                by(ContinuousMotion::kShortest)),
               Error);
  EXPECT_NO_THROW(swing.check_edge(Configuration{99.9}, Configuration{89.33}, other));
}

}  // namespace
}  // namespace spherule::test::robot_shortest_edge_test
