// SPDX-License-Identifier: BSD-3-Clause
// Straight motions of a robot among obstacles and against itself, against many configurations on
// them and against positions of contact known by hand.

#include "base/error.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_checker.h"
#include "spheretree/build.h"
#include "tests/robot/check/edge_oracle.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace spherule::test::robot_checker_edge_test {
namespace {

using Configuration = std::vector<double>;

void expect_so(const RobotChecker& checker, const Configuration& from, const Configuration& to,
               const EdgeResult& result, int steps) {
  RobotChecker::Scratch scratch(checker);
  const auto hits = [&](const Configuration& at) { return !checker.check_config(at, scratch); };
  test::expect_so(hits, from, to, result, steps);
}

struct Counts {
  int free = 0;
  int hits = 0;
  int unknown = 0;
  void count(Verdict verdict) {
    (verdict == Verdict::kFree ? free : verdict == Verdict::kCollision ? hits : unknown) += 1;
  }
};

TEST(RobotCheckerEdge, WhatIsProvedFreeIsFree) {
  Random random(seeded(81));
  Counts counts;
  for (int n = 0; n < scaled(60, 12); ++n) {
    const auto [scene, oracle] = random_scene(random);
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < 8; ++i) {
      const double size = std::pow(10.0, random.between(-3.0, 1.0));
      const Configuration from = random_configuration(random, oracle.robot, 3.0);
      if (!checker.check_config(from, scratch)) continue;
      Configuration to = random_configuration(random, oracle.robot, size);
      for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
      const EdgeRequest request{.resolution = 1e-3, .first = i % 3 == 0};
      const EdgeResult result = checker.check_edge(from, to, scratch, request);
      counts.count(result.verdict);
      expect_so(checker, from, to, result, i == 0 ? effort(4000, 200) : effort(300, 100));
      if (HasFatalFailure()) return;
      if (i % 3 != 0) continue;
      EXPECT_EQ(checker.measure_edge(from, to, scratch, 1e-3), result.free_until);
    }
  }
  EXPECT_GT(counts.free, effort(60, 8));
  EXPECT_GT(counts.hits, effort(15, 2));
  EXPECT_LT(counts.unknown, (counts.free + counts.hits) / 20 + 1);
}

// A wall of one sheet of spheres, 0.03 thick, without a gap, in the plane x = 0.
std::shared_ptr<const SphereTree> wall() {
  std::vector<Sphere> spheres;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) spheres.push_back({{0.0, 0.02 * i, 0.02 * k}, 0.015});
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// The wall is on a link that moves, and a drill on another one: nothing stands still.
TEST(RobotCheckerEdge, AWallOnALinkIsNotPassed) {
  Random random(seeded(82));
  RobotModel robot("base");
  robot.add_link("door", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -99, .upper = 99});
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -99, .upper = 99});
  robot.add_link("drill", "slide", {.type = JointType::kContinuous, .axis = {1, 0, 0}});
  robot.attach("door", wall());
  robot.attach("drill", one_sphere_tree({0.0, 0.1, 0.05}, 1e-3));
  const RobotChecker checker = RobotScene(robot).snapshot();
  RobotChecker::Scratch scratch(checker);
  for (int i = 0; i < scaled(200, 20); ++i) {
    const double side = random.whole(0, 1) == 0 ? 1.0 : -1.0;
    const Configuration from = {random.between(-30.0, 30.0), 0.0, random.between(-9.0, 9.0)};
    Configuration to = {random.between(-30.0, 30.0), 0.0, random.between(-9.0, 9.0)};
    Configuration start = from;
    start[1] = from[0] - side * random.between(0.05, 40.0);
    to[1] = to[0] + side * random.between(0.05, 40.0);
    const EdgeResult result = checker.check_edge(start, to, scratch, {.first = true});
    EXPECT_NE(result.verdict, Verdict::kFree);
    expect_so(checker, start, to, result, 200);
    const Configuration reached = on_the_way(start, to, result.free_until);
    EXPECT_NEAR(std::abs(reached[1] - reached[0]), 0.011, 0.0055) << "up to the wall, no further";
  }
}

// A blade that turns by many turns through a thin plate, which hangs on the other side of the root.
TEST(RobotCheckerEdge, ATurningBladeMeetsAPlate) {
  Random random(seeded(83));
  for (int i = 0; i < scaled(150, 30); ++i) {
    const double angle = random.between(-3.0, 3.0);
    const double size = std::pow(10.0, random.between(-5.0, -2.0));
    const double radius = random.between(0.2, 5.0);
    const bool intersects = random.whole(0, 1) == 0;
    RobotModel robot("base");
    robot.add_link("left", "base", {.type = JointType::kContinuous});
    robot.add_link("right", "base", {.type = JointType::kContinuous});
    robot.attach("left", one_sphere_tree({radius, 0, 0}, size));
    robot.attach("right", one_sphere_tree({radius * std::cos(angle), radius * std::sin(angle),
                                           intersects ? 1.2 * size : 2.4 * size + 2e-4},
                                          size));
    const RobotChecker checker = RobotScene(robot).snapshot();
    RobotChecker::Scratch scratch(checker);
    // Both turn, one against the other by more than a turn.
    const double together = random.between(-20.0, 20.0);
    const Configuration from = {0.0, random.between(0.3, 2.9)};
    const Configuration to = {together, from[1] + together + (i % 2 == 0 ? 6.3 : -6.3)};
    const EdgeResult result = checker.check_edge(from, to, scratch, {.first = true});
    EXPECT_EQ(result.verdict == Verdict::kFree, !intersects) << size << ' ' << radius;
    expect_so(checker, from, to, result, effort(500, 100));
    if (!intersects) continue;
    // The right one is at angle + q1 - q0 as seen from the left one: met at 0 or a whole turn.
    const double way = i % 2 == 0 ? 6.3 : -6.3;
    double at = -(angle + from[1]);
    const double turn = 2.0 * std::numbers::pi * (way > 0.0 ? 1.0 : -1.0);
    while (at * way < 0.0) at += turn;
    while ((at - turn) * way > 0.0) at -= turn;
    EXPECT_LE(result.free_until, at / way);
    EXPECT_NEAR(result.free_until, at / way, (2.1 * size + 1e-4) / radius / 6.3 + 1e-6);
  }
}

// What moves both of two links does not move one against the other: examined once.
TEST(RobotCheckerEdge, OnlyJointsBetweenTheTwoCount) {
  RobotModel robot("base");
  const Joint turning{.type = JointType::kContinuous, .axis = {1, 2, 3}};
  robot.add_link("shoulder", "base", turning);
  robot.add_link(
      "elbow", "shoulder",
      {.type = JointType::kContinuous, .parent_from_joint = Pose::from_translation({3, 0, 0})});
  const auto finger = [](double x) {
    return Joint{.type = JointType::kPrismatic,
                 .parent_from_joint = Pose::from_translation({x, 0, 0}),
                 .axis = {1, 0, 0},
                 .lower = -1,
                 .upper = 1};
  };
  robot.add_link("left", "elbow", finger(0.0));
  robot.add_link("right", "elbow", finger(0.05));
  robot.attach("left", one_sphere_tree({0, 0, 0}, 0.02));
  robot.attach("right", one_sphere_tree({0, 0, 0}, 0.02));
  const RobotChecker checker = RobotScene(robot).snapshot();
  RobotChecker::Scratch scratch(checker);
  const EdgeResult free = checker.check_edge(Configuration{-50, 40, 0.0, 0.0},
                                             Configuration{50, -40, 0.0001, 0.0}, scratch);
  EXPECT_EQ(free.verdict, Verdict::kFree);
  EXPECT_EQ(free.configurations, 8U);
  const EdgeResult met =
      checker.check_edge(Configuration{-50, 40, 0.0, 0.0}, Configuration{50, -40, 0.02, 0.0},
                         scratch, {.first = true});
  EXPECT_EQ(met.verdict, Verdict::kCollision);
  EXPECT_NEAR(met.free_until, 0.5, 0.01);
}

// Two fingers, of which the second mirrors the first.
TEST(RobotCheckerEdge, MimicJointsMoveToo) {
  RobotModel robot("hand");
  const auto finger = [](std::string name, double x) {
    return Joint{.name = std::move(name),
                 .type = JointType::kPrismatic,
                 .parent_from_joint = Pose::from_translation({x, 0, 0}),
                 .axis = {1, 0, 0},
                 .lower = -1,
                 .upper = 1};
  };
  robot.add_link("left", "hand", finger("left_finger", -0.1));
  robot.add_link("right", "hand", finger("right_finger", 0.1));
  robot.mimic("right_finger", "left_finger", -3.0, 0.01);
  robot.attach("left", one_sphere_tree({0, 0, 0}, 0.01));
  robot.attach("right", one_sphere_tree({0, 0, 0}, 0.01));
  RobotScene scene(robot);
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  // The distance is 0.2 + 0.01 - 4 q.
  EXPECT_TRUE(checker.check_config(Configuration{0.0474}, scratch));
  EXPECT_FALSE(checker.check_config(Configuration{0.0476}, scratch));
  const double alpha = checker.measure_edge(Configuration{0.0}, Configuration{0.1}, scratch, 1e-5);
  EXPECT_LE(alpha, 0.475);
  EXPECT_NEAR(alpha, 0.475, 1e-3);
  // The right finger's limits are those of its own position, 0.01 - 3 q >= -1.
  const RobotChecker limited = scene.snapshot({.enforce_limits = true});
  RobotChecker::Scratch other(limited);
  EXPECT_TRUE(limited.check_config(Configuration{-0.32}, other));
  EXPECT_FALSE(limited.check_config(Configuration{-0.34}, other));
  EXPECT_TRUE(checker.check_config(Configuration{-0.34}, scratch));
}

TEST(RobotCheckerEdge, LimitsEndAMotion) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -1.0, .upper = 1.0});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 0.1));
  RobotScene scene(robot);
  scene.add("post", one_sphere_tree({0.8, 0, 0}, 0.1), Pose());
  const RobotChecker checker = scene.snapshot({.enforce_limits = true});
  RobotChecker::Scratch scratch(checker);
  const auto measure = [&](double from, double to) {
    const Configuration a = {from};
    const Configuration b = {to};
    const EdgeResult result = checker.check_edge(a, b, scratch, {.first = true});
    expect_so(checker, a, b, result, 50);
    const EdgeResult any = checker.check_edge(a, b, scratch);
    expect_so(checker, a, b, any, 50);
    EXPECT_EQ(any.verdict, result.verdict);
    return result;
  };
  EXPECT_EQ(measure(0.0, -1.0).verdict, Verdict::kFree);
  const EdgeResult beyond = measure(0.0, -2.0);
  EXPECT_EQ(beyond.verdict, Verdict::kCollision);
  EXPECT_NEAR(beyond.free_until, 0.5, 1e-9);
  EXPECT_LE(beyond.free_until, 0.5);
  const EdgeResult post = measure(0.0, 2.0);
  EXPECT_NEAR(post.free_until, 0.3, 1e-3);
  EXPECT_EQ(measure(-1.5, 0.0).free_until, 0.0);
  EXPECT_EQ(measure(-1.0, -1.5).free_until, 0.0);
}

// Solids of other kinds in the way of a sphere on a slide that turns.
TEST(RobotCheckerEdge, StopsAtSolidsOfEveryKind) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -9, .upper = 9});
  robot.add_link("spindle", "slide", {.type = JointType::kContinuous, .axis = {1, 0, 0}});
  robot.attach("spindle", one_sphere_tree({0, 0, 0}, 0.05));
  const std::vector<std::pair<ObstacleShape, double>> shapes = {
      {Primitive(Box{{0.2, 1, 1}}), 0.1},
      {Primitive(SolidSphere{0.3}), 0.3},
      {Primitive(Cylinder{0.25, 1.0}), 0.25},
      {Primitive(Capsule{0.2, 1.0}), 0.2},
      {std::make_shared<const SolidMesh>(
           box_mesh(Eigen::Vector3d(-0.15, -1, -1), Eigen::Vector3d(0.15, 1, 1))),
       0.15},
      {one_sphere_tree({0, 0, 0}, 0.4), 0.4},
  };
  for (const auto& [shape, half] : shapes) {
    RobotScene scene(robot);
    scene.add("thing", shape, Pose::from_translation({2, 0, 0}));
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    const Configuration from = {0.0, 0.0};
    const Configuration to = {4.0, 20.0};
    const EdgeResult result = checker.check_edge(from, to, scratch, {.first = true});
    EXPECT_EQ(result.verdict, Verdict::kCollision) << half;
    EXPECT_NEAR(result.free_until, (2.0 - half - 0.05) / 4.0, 1e-4);
    expect_so(checker, from, to, result, 500);
    const auto met =
        checker.explain(checker.configuration_on_edge(from, to, result.contact_at), scratch);
    ASSERT_EQ(met.size(), 1U) << half;
    EXPECT_EQ(met[0].second.name, "thing");
    // Wholly inside, far from any surface, is a contact as well.
    EXPECT_FALSE(checker.check_config(Configuration{2.0, 0.0}, scratch));
    const auto told = checker.explain(Configuration{2.0, 0.0}, scratch);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].first.name, "spindle");
    EXPECT_EQ(told[0].second.name, "thing");
    EXPECT_EQ(told[0].second.kind, CheckedBody::Kind::kObstacle);
    EXPECT_GT(told[0].overlap_depth, 0.05);
    // Bounds of the gap, from in front of it.
    const RobotClearance clearance = checker.clearance(Configuration{1.0, 3.0}, scratch);
    EXPECT_LE(clearance.lower, 0.95 - half);
    EXPECT_NEAR(clearance.lower, 0.95 - half, 1e-6);
    EXPECT_NEAR(clearance.upper, 0.95 - half, 1e-6);
    scene.set_padding("spindle", "thing", 0.1);
    const RobotChecker padded = scene.snapshot();
    RobotChecker::Scratch other(padded);
    EXPECT_NEAR(padded.measure_edge(from, to, other), (1.85 - half) / 4.0, 1e-4);
  }
  RobotScene floor(robot);
  const Pose x_down(
      Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitY())),
      Eigen::Vector3d(1.5, 0, 0));
  floor.add("floor", Primitive(HalfSpace{}), x_down);
  const RobotChecker checker = floor.snapshot();
  RobotChecker::Scratch scratch(checker);
  EXPECT_NEAR(checker.measure_edge(Configuration{0.0, 0.0}, Configuration{4.0, 9.0}, scratch),
              1.45 / 4.0, 1e-4);
}

TEST(RobotCheckerEdge, ManyAnswerAsOne) {
  Random random(seeded(84));
  const auto [scene, oracle] = random_scene(random);
  const RobotChecker checker = scene.snapshot();
  std::vector<RobotChecker::Scratch> scratches;
  for (int i = 0; i < 3; ++i) scratches.emplace_back(checker);
  std::vector<double> path;
  std::vector<Configuration> points;
  for (int i = 0; i < 100; ++i) {
    points.push_back(random_configuration(random, oracle.robot, 3.0));
    path.insert(path.end(), points.back().begin(), points.back().end());
  }
  const auto variables = static_cast<std::size_t>(oracle.robot.variable_count());
  ASSERT_GT(variables, 0U);
  const std::span<const double> all(path);
  const std::vector<EdgeResult> results = checker.check_edges(
      all.first(99 * variables), all.last(99 * variables), scratches, {.first = true});
  ASSERT_EQ(results.size(), 99U);
  for (std::size_t i = 0; i < 99; ++i) {
    const EdgeResult one =
        checker.check_edge(points[i], points[i + 1], scratches[0], {.first = true});
    EXPECT_EQ(results[i].verdict, one.verdict);
    EXPECT_EQ(results[i].free_until, one.free_until);
    EXPECT_EQ(results[i].contact_at, one.contact_at);
  }
  EXPECT_THROW((void)checker.check_edges(all.first(variables), all, scratches), Error);
  EXPECT_THROW((void)checker.check_edges(all, all, {}), Error);
}

TEST(RobotCheckerEdge, BudgetsLeaveTheAnswerOpen) {
  RobotModel robot("base");
  robot.add_link("a", "base", {.type = JointType::kContinuous});
  robot.add_link("b", "base", {.type = JointType::kContinuous});
  robot.attach("a", one_sphere_tree({1, 0, 0}, 0.01));
  robot.attach("b", one_sphere_tree({1, 0, 0.0202}, 0.01));
  RobotScene scene(robot);
  scene.add("post", one_sphere_tree({-1, 0, 0.0404}, 0.01), Pose());
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  const Configuration from = {0.5, 2.0};
  const Configuration to = {4.0, -3.0};
  const EdgeResult all = checker.check_edge(from, to, scratch, {.resolution = 1e-5});
  EXPECT_EQ(all.verdict, Verdict::kFree);
  for (std::uint64_t budget = 0; budget < all.configurations; ++budget) {
    const EdgeResult result =
        checker.check_edge(from, to, scratch, {.resolution = 1e-5, .max_configurations = budget});
    EXPECT_EQ(result.verdict, Verdict::kUnknown);
    EXPECT_LE(result.configurations, budget);
    expect_so(checker, from, to, result, 20);
  }
}

}  // namespace
}  // namespace spherule::test::robot_checker_edge_test
