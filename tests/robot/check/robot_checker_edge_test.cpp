// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
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

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <variant>
#include <vector>

// Straight motions of a robot among obstacles and against itself, against many configurations on
// them and against positions of contact known by hand.

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

// Motions past and through thin solids and other links, made so that they come closest, or touch,
// at a known place in between: judged by plain distances under the poses of forward_kinematics().

namespace spherule::test::robot_edge_passes_test {
namespace {

using Configuration = std::vector<double>;
using Eigen::Vector3d;

// Of a point outside to a solid in its frame.
struct DistanceTo {
  const Vector3d& p;

  double operator()(const Box& box) const {
    return (p.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm();
  }
  double operator()(const SolidSphere& sphere) const { return p.norm() - sphere.radius; }
  double operator()(const Cylinder& solid) const {
    return std::hypot(std::max(0.0, std::hypot(p.x(), p.y()) - solid.radius),
                      std::max(0.0, std::abs(p.z()) - 0.5 * solid.length));
  }
  double operator()(const Capsule& solid) const {
    const double beyond = std::max(0.0, std::abs(p.z()) - 0.5 * solid.length);
    return std::hypot(p.x(), p.y(), beyond) - solid.radius;
  }
  double operator()(const HalfSpace&) const { return p.z(); }
};

struct Static {
  Primitive solid;
  Pose world_from_solid;
};

// A robot each of whose links carries one sphere.
struct SphereRobot {
  RobotModel model;
  std::vector<Sphere> spheres;  // of links
};

SphereRobot random_sphere_robot(Random& random, bool branching) {
  SphereRobot result{random_robot(random, random.whole(2, 7), branching), {}};
  if (random.whole(0, 3) == 0) add_random_mimics(random, result.model, 1.0);
  for (const Link& link : std::vector<Link>(result.model.links())) {
    result.spheres.push_back({random.point(0.5), std::pow(10.0, random.between(-4.0, -1.0))});
    result.model.attach(
        link.name, one_sphere_tree(result.spheres.back().center, result.spheres.back().radius));
  }
  return result;
}

std::vector<Vector3d> placed(const SphereRobot& robot, const Configuration& at) {
  std::vector<Pose> poses;
  forward_kinematics(robot.model, at, poses);
  std::vector<Vector3d> centers;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    centers.push_back(poses[i] * robot.spheres[i].center);
  }
  return centers;
}

struct Move {
  Configuration from;
  Configuration to;
  double between;  // a fraction, not near the ends
};

// Of up to several turns.
Move random_move(Random& random, const RobotModel& robot) {
  Move move{random_configuration(random, robot, 3.0),
            random_configuration(random, robot, std::pow(10.0, random.between(-2.0, 1.3))),
            random.between(0.1, 0.9)};
  for (std::size_t i = 0; i < move.to.size(); ++i) move.to[i] += move.from[i];
  return move;
}

// Of the sphere that is told it is `gap` away there.
Static solid_beside(Random& random, const Vector3d& center, double radius, double gap) {
  const double thin = std::pow(10.0, random.between(-5.0, -1.0));
  const double large = random.between(0.05, 0.5);
  const Primitive solids[] = {Box{{large, large, thin}}, SolidSphere{thin}, Cylinder{large, thin},
                              Capsule{thin, large}, HalfSpace{}};
  const Primitive solid = solids[random.whole(0, 4)];
  // How far the surface is from the origin, along z; along x for a capsule.
  const bool is_capsule = std::holds_alternative<Capsule>(solid);
  const double surface = std::holds_alternative<HalfSpace>(solid)                   ? 0.0
                         : is_capsule || std::holds_alternative<SolidSphere>(solid) ? thin
                                                                                    : 0.5 * thin;
  const Eigen::Quaterniond turn = random.quaternion().normalized();
  const Vector3d normal = turn * (is_capsule ? Vector3d::UnitX() : Vector3d::UnitZ());
  return {solid, Pose(turn, center - (surface + radius + gap) * normal)};
}

// No link is tested against another.
AllowedCollisions all_allowed(const RobotModel& robot) {
  AllowedCollisions allowed(robot);
  for (int i = 0; i < static_cast<int>(robot.links().size()); ++i) {
    for (int k = 0; k < i; ++k) allowed.allow(k, i, AllowedReason::kGiven);
  }
  return allowed;
}

RobotChecker checker_of(const SphereRobot& robot, const std::vector<Static>& solids) {
  RobotScene scene(robot.model);
  if (!solids.empty()) scene.set_allowed_collisions(all_allowed(robot.model));
  for (std::size_t i = 0; i < solids.size(); ++i) {
    scene.add("solid " + std::to_string(i), solids[i].solid, solids[i].world_from_solid);
  }
  return scene.snapshot();
}

double gap_to(const SphereRobot& robot, const std::vector<Static>& solids,
              const Configuration& at) {
  const std::vector<Vector3d> centers = placed(robot, at);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [solid, pose] : solids) {
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const Vector3d p = pose.matrix().transpose() * (centers[i] - pose.translation());
      least = std::min(least, std::visit(DistanceTo{p}, solid) - robot.spheres[i].radius);
    }
  }
  return least;
}

TEST(RobotEdgePasses, NoSolidIsPassedThrough) {
  Random random(311);
  int found = 0;
  const int cases = effort(4000, 400);
  for (int n = 0; n < cases; ++n) {
    const SphereRobot robot = random_sphere_robot(random, false);
    if (robot.model.variable_count() == 0) continue;
    const Move move = random_move(random, robot.model);
    const std::size_t last = robot.spheres.size() - 1;
    const Vector3d center = placed(robot, on_the_way(move.from, move.to, move.between))[last];
    const double radius = robot.spheres[last].radius;
    const std::vector<Static> solids = {
        solid_beside(random, center, radius, -radius * random.between(1e-6, 1.0))};
    const RobotChecker checker = checker_of(robot, solids);
    RobotChecker::Scratch scratch(checker);
    const bool first = n % 2 == 0;
    const EdgeResult result =
        checker.check_edge(move.from, move.to, scratch, {.resolution = 1e-3, .first = first});
    ASSERT_NE(result.verdict, Verdict::kFree) << n;
    ASSERT_LE(result.free_until, move.between) << n;
    found += result.verdict == Verdict::kCollision ? 1 : 0;
    const auto hits = [&](const Configuration& at) { return gap_to(robot, solids, at) <= 1e-12; };
    expect_so(hits, move.from, move.to, result, effort(20, 10));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(found, cases / 2);
}

// The moving joints from a link to the root.
std::set<int> joints_above(const RobotModel& robot, std::size_t link) {
  std::set<int> joints;
  for (int joint = robot.links()[link].parent_joint; joint >= 0;) {
    const Joint& at = robot.joints()[static_cast<std::size_t>(joint)];
    if (at.moves()) joints.insert(joint);
    joint = robot.links()[static_cast<std::size_t>(at.parent_link)].parent_joint;
  }
  return joints;
}

TEST(RobotEdgePasses, NoLinkIsPassedThrough) {
  Random random(312);
  int tested = 0;
  int found = 0;
  const int cases = effort(3000, 300);
  for (int n = 0; n < cases; ++n) {
    SphereRobot robot = random_sphere_robot(random, true);
    const Move move = random_move(random, robot.model);
    const Configuration between = on_the_way(move.from, move.to, move.between);
    const std::vector<Vector3d> centers = placed(robot, between);
    const std::size_t last = robot.spheres.size() - 1;
    const std::size_t other = static_cast<std::size_t>(random.whole(0, static_cast<int>(last) - 1));
    // No joint moves the two against each other where the same ones move both.
    if (joints_above(robot.model, last) == joints_above(robot.model, other)) continue;
    ++tested;
    // In the last link's sphere, carried by another link.
    const double size = std::pow(10.0, random.between(-5.0, -1.0));
    const double apart = (size + robot.spheres[last].radius) * random.between(0.0, 0.9999);
    std::vector<Pose> poses;
    forward_kinematics(robot.model, between, poses);
    const Vector3d beside = centers[last] + apart * random.point(1.0).normalized();
    RobotScene scene(robot.model);
    scene.set_allowed_collisions(all_allowed(robot.model));
    scene.attach("trap", robot.model.links()[other].name,
                 one_sphere_tree(poses[other].inverse() * beside, size));
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    ASSERT_FALSE(checker.check_config(between, scratch)) << n;
    const EdgeResult result =
        checker.check_edge(move.from, move.to, scratch, {.resolution = 1e-3, .first = n % 2 == 0});
    ASSERT_NE(result.verdict, Verdict::kFree) << n;
    ASSERT_LE(result.free_until, move.between) << n;
    found += result.verdict == Verdict::kCollision ? 1 : 0;
  }
  EXPECT_GT(tested, cases / 2);
  EXPECT_GT(found, tested / 2);
}

TEST(RobotEdgePasses, WhatIsProvedAmongSolidsIsFree) {
  Random random(313);
  int free = 0;
  int unknown = 0;
  const int cases = effort(600, 60);
  for (int n = 0; n < cases; ++n) {
    const SphereRobot robot = random_sphere_robot(random, false);
    const Move move = random_move(random, robot.model);
    std::vector<Static> solids;
    for (int i = 0; i < 3; ++i) {
      const double t = random.between(0.0, 1.0);
      const std::size_t link =
          static_cast<std::size_t>(random.whole(0, static_cast<int>(robot.spheres.size()) - 1));
      const Configuration at = on_the_way(move.from, move.to, t);
      solids.push_back(solid_beside(random, placed(robot, at)[link], robot.spheres[link].radius,
                                    std::pow(10.0, random.between(-4.0, 0.0))));
    }
    const RobotChecker checker = checker_of(robot, solids);
    RobotChecker::Scratch scratch(checker);
    const double resolution = 1e-3;
    const EdgeResult result =
        checker.check_edge(move.from, move.to, scratch, {.resolution = resolution, .first = true});
    const auto hits = [&](const Configuration& at) { return gap_to(robot, solids, at) <= 1e-12; };
    expect_so(hits, move.from, move.to, result, effort(1000, 100));
    if (HasFatalFailure()) return;
    free += result.verdict == Verdict::kFree ? 1 : 0;
    if (result.verdict != Verdict::kUnknown) continue;
    // Something is near where the proof ends, whatever else.
    ++unknown;
    EXPECT_LE(gap_to(robot, solids, on_the_way(move.from, move.to, result.free_until)),
              1.6 * resolution);
  }
  EXPECT_GT(free, cases / 20);
  EXPECT_LT(unknown, cases / 4);
}

// Along a wall, at a distance that does not change: one evaluation is enough, however long the
// motion is.
TEST(RobotEdgePasses, NothingIsLostBySlidingAlongAWall) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -90, .upper = 90});
  robot.attach("slide", one_sphere_tree({0, 0, 0.1}, 0.05));
  RobotScene scene(robot);
  scene.add("floor", Primitive(Box{{200, 1, 0.02}}), Pose::from_translation({0, 0, 0.0394}));
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  const Configuration from = {-80.0};
  const Configuration to = {80.0};
  const auto check = [&](double resolution) {
    return checker.check_edge(from, to, scratch, {.resolution = resolution});
  };
  EXPECT_EQ(check(1e-4).verdict, Verdict::kFree);
  // Eight middles in single precision, and the eight parts once more in double.
  EXPECT_LE(check(1e-4).configurations, 72U);
  EXPECT_EQ(check(1e-2).verdict, Verdict::kFree) << "at a gap of 0.6 mm";
  scene.move("floor", Pose::from_translation({0, 0, 0.0401}));
  const RobotChecker met = scene.snapshot();
  RobotChecker::Scratch other(met);
  EXPECT_EQ(met.check_edge(from, to, other).verdict, Verdict::kCollision);
}

}  // namespace
}  // namespace spherule::test::robot_edge_passes_test
