// SPDX-License-Identifier: BSD-3-Clause
// Straight motions of a robot among obstacles and against itself, against many configurations on
// them and against positions of contact known by hand.

#include "base/error.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/refusals.h"
#include "tests/robot/robots.h"
#include "tests/robot/solid_oracle.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// Among solids and meshes, too, and on every instruction set: by the canonical tests of all pairs
// and, at some places, by all pairs of spheres in extended precision.
TEST(RobotCheckerEdge, WhatIsProvedFreeIsFree) {
  Random random(seeded(81));
  VerdictCounts counts;
  for (int n = 0; n < scaled(60, 8); ++n) {
    const RandomScene in = n % 3 == 0 ? random_scene(random) : scene_with_solids(random);
    const Random motions(random.bits());  // the same on every instruction set
    for (const InstructionSet set : instruction_sets()) {
      Checked checked(in.scene, {.instructions = set});
      const auto touches = [&](const Configuration& at) { return !checked.explain(at).empty(); };
      Random motion = motions;
      for (int i = 0; i < 4; ++i) {
        const Configuration from = random_configuration(motion, in.oracle.robot, 3.0);
        const double size = std::pow(10.0, motion.between(-3.0, 1.0));
        const Configuration to = moved(from, random_configuration(motion, in.oracle.robot, size));
        if (touches(from)) continue;
        const EdgeRequest request{.resolution = 1e-3, .first = i % 3 == 0};
        const EdgeResult result = checked.edge(from, to, request);
        counts.count(result.verdict);
        expect_so(touches, from, to, result, i == 0 ? effort(300, 60) : effort(60, 20));
        if (HasFailure()) return;
        for (const double part : {0.25, 0.75}) {
          const auto gap = in.oracle.gap(on_the_way(from, to, part * result.free_until));
          EXPECT_TRUE(!gap || *gap > 0.0L || result.free_until == 0.0);
        }
        if (i % 3 != 0) continue;
        EXPECT_EQ(checked.checker.measure_edge(from, to, checked.scratch, 1e-3), result.free_until);
      }
    }
  }
  EXPECT_GT(counts.free, effort(60, 5));
  EXPECT_GT(counts.hits, effort(20, 2));
  EXPECT_LT(counts.unknown, (counts.free + counts.hits) / 20 + 1);
}

// Motions that follow each other in steps of any size, beside what was found near: what the scratch
// remembers proves many of them, and none that is not free.
TEST(RobotCheckerEdge, WhatIsProvedFreeAlongAPathIsFree) {
  Random random(seeded(55));
  VerdictCounts counts;
  int remembered = 0;
  for (int i = 0; i < scaled(300, 20); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.2);
    if (robot.variable_count() == 0) continue;
    Configuration at = random_configuration(random, robot, 3.0);
    std::vector<Pose> links;
    forward_kinematics(robot, at, links);
    const std::optional<Sphere> near = random_sphere_of(random, robot, links);
    if (!near) continue;
    // A sphere that the path begins beside.
    const double gap = std::pow(10.0, random.between(-6.0, -1.0));
    const Vector3d center =
        near->center + (near->radius + 0.05 + gap) * random.point(1.0).normalized();
    Checked checked(obstacle_checker(robot, {{one_sphere_tree(center, 0.05)}}));
    double step = 0.0;
    Configuration heading;
    for (int k = 0; k < 60; ++k) {
      if (k % 15 == 0) {
        step = std::pow(10.0, random.between(-5.0, -1.5));
        heading = random_configuration(random, robot, step);
      }
      const Configuration to =
          moved(moved(at, heading), random_configuration(random, robot, 0.1 * step));
      const EdgeResult result = checked.edge(at, to, {.first = k % 7 == 0});
      expect_so(checked.checker, at, to, result, effort(100, 30));
      if (HasFailure()) return;
      counts.count(result.verdict);
      remembered += result.configurations == 1 ? 1 : 0;
      at = to;
    }
  }
  EXPECT_GT(counts.free, effort(3000, 200));
  EXPECT_GT(remembered, effort(2000, 100));
  EXPECT_GT(counts.hits, effort(1000, 50));
  EXPECT_LT(counts.unknown, (counts.free + counts.hits) / 20);
}

// A wall of one sheet of spheres, 0.03 thick, without a gap, in the plane x = 0.
std::shared_ptr<const SphereTree> wall() {
  std::vector<Sphere> spheres;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) spheres.push_back({{0.0, 0.02 * i, 0.02 * k}, 0.015});
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// A drill that slides and turns. The wall is on a link that moves, too, or is an obstacle.
TEST(RobotCheckerEdge, AWallIsNotPassed) {
  Random random(seeded(82));
  const auto sheet = wall();
  for (const bool is_link : {true, false}) {
    RobotModel robot("base");
    robot.add_link("door", "base", sliding(-99, 99));
    robot.add_link("slide", "base", sliding(-99, 99));
    robot.add_link("drill", "slide", wheel("", Vector3d::UnitX()));
    if (is_link) robot.attach("door", sheet);
    robot.attach("drill", one_sphere_tree({0.0, 0.1, 0.05}, 1e-3));
    RobotScene scene(robot);
    if (!is_link) scene.add("wall", sheet);
    Checked checked(scene);
    for (int i = 0; i < scaled(200, 20); ++i) {
      const double side = random.sign();
      const double before = is_link ? random.between(-30.0, 30.0) : 0.0;
      const double after = is_link ? random.between(-30.0, 30.0) : 0.0;
      const Configuration from = {before, before - side * random.between(0.05, 40.0),
                                  random.between(-9.0, 9.0)};
      const Configuration to = {after, after + side * random.between(0.05, 40.0),
                                random.between(-9.0, 9.0)};
      const EdgeResult result = checked.edge(from, to, {.first = true});
      EXPECT_NE(result.verdict, Verdict::kFree);
      expect_so(checked.checker, from, to, result, 200);
      const Configuration reached = on_the_way(from, to, result.free_until);
      EXPECT_NEAR(std::abs(reached[1] - reached[0]), 0.011, 0.0055) << "up to the wall, no further";
    }
  }
}

// A blade that turns by many turns through a thin plate, which hangs on the other side of the root.
TEST(RobotCheckerEdge, ATurningBladeMeetsAPlate) {
  Random random(seeded(83));
  for (int i = 0; i < scaled(150, 30); ++i) {
    const double angle = random.between(-3.0, 3.0);
    const double size = std::pow(10.0, random.between(-5.0, -2.0));
    const double radius = random.between(0.2, 5.0);
    const bool intersects = random.coin();
    RobotModel robot = one_arm(wheel(), {radius, 0, 0}, size);
    robot.add_link("right", "base", wheel());
    robot.attach("right", one_sphere_tree({radius * std::cos(angle), radius * std::sin(angle),
                                           intersects ? 1.2 * size : 2.4 * size + 2e-4},
                                          size));
    Checked checked{RobotScene(robot)};
    // Both turn, one against the other by more than a turn.
    const double together = random.between(-20.0, 20.0);
    const double way = i % 2 == 0 ? 6.3 : -6.3;
    const Configuration from = {0.0, random.between(0.3, 2.9)};
    const Configuration to = {together, from[1] + together + way};
    const EdgeResult result = checked.edge(from, to, {.first = true});
    EXPECT_EQ(result.verdict == Verdict::kFree, !intersects) << size << ' ' << radius;
    expect_so(checked.checker, from, to, result, effort(500, 100));
    if (!intersects) continue;
    // The right one is at angle + q1 - q0 as seen from the left one: met at 0 or a whole turn.
    double at = -(angle + from[1]);
    const double turn = 2.0 * kPi * (way > 0.0 ? 1.0 : -1.0);
    while (at * way < 0.0) at += turn;
    while ((at - turn) * way > 0.0) at -= turn;
    EXPECT_LE(result.free_until, at / way);
    EXPECT_NEAR(result.free_until, at / way, (2.1 * size + 1e-4) / radius / 6.3 + 1e-6);
  }
}

// What moves both of two links does not move one against the other: examined once.
TEST(RobotCheckerEdge, OnlyJointsBetweenTheTwoCount) {
  RobotModel robot("base");
  robot.add_link("shoulder", "base", wheel("", {1, 2, 3}));
  Joint elbow = wheel();
  elbow.parent_from_joint = Pose::from_translation({3, 0, 0});
  robot.add_link("elbow", "shoulder", elbow);
  for (const char* const finger : {"left", "right"}) {
    Joint joint = sliding(-1, 1);
    if (finger == std::string("right"))
      joint.parent_from_joint = Pose::from_translation({0.05, 0, 0});
    robot.add_link(finger, "elbow", joint);
    robot.attach(finger, one_sphere_tree({0, 0, 0}, 0.02));
  }
  Checked checked{RobotScene(robot)};
  const EdgeResult free = checked.edge({-50, 40, 0.0, 0.0}, {50, -40, 0.0001, 0.0});
  EXPECT_EQ(free.verdict, Verdict::kFree);
  EXPECT_EQ(free.configurations, 8U);
  const EdgeResult met = checked.edge({-50, 40, 0.0, 0.0}, {50, -40, 0.02, 0.0}, {.first = true});
  EXPECT_EQ(met.verdict, Verdict::kCollision);
  EXPECT_NEAR(met.free_until, 0.5, 0.01);
}

// Two fingers, of which the second mirrors the first.
TEST(RobotCheckerEdge, MimicJointsMoveToo) {
  RobotModel robot("hand");
  for (const double x : {-0.1, 0.1}) {
    const std::string name = x < 0.0 ? "left" : "right";
    Joint joint = sliding(-1, 1, name + "_finger");
    joint.parent_from_joint = Pose::from_translation({x, 0, 0});
    robot.add_link(name, "hand", joint);
    robot.attach(name, one_sphere_tree({0, 0, 0}, 0.01));
  }
  robot.mimic("right_finger", "left_finger", -3.0, 0.01);
  const RobotScene scene(robot);
  Checked checked(scene);
  // The distance is 0.2 + 0.01 - 4 q.
  EXPECT_TRUE(checked.free(Configuration{0.0474}));
  EXPECT_FALSE(checked.free(Configuration{0.0476}));
  const double alpha =
      checked.checker.measure_edge(Configuration{0.0}, Configuration{0.1}, checked.scratch, 1e-5);
  EXPECT_LE(alpha, 0.475);
  EXPECT_NEAR(alpha, 0.475, 1e-3);
  // The right finger's limits are those of its own position, 0.01 - 3 q >= -1.
  Checked limited(scene, {.enforce_limits = true});
  EXPECT_TRUE(limited.free(Configuration{-0.32}));
  EXPECT_FALSE(limited.free(Configuration{-0.34}));
  EXPECT_TRUE(checked.free(Configuration{-0.34}));
}

TEST(RobotCheckerEdge, LimitsEndAMotion) {
  RobotScene scene(one_arm(sliding(-1.0, 1.0), {0, 0, 0}, 0.1));
  scene.add("post", one_sphere_tree({0.8, 0, 0}, 0.1), Pose());
  Checked checked(scene, {.enforce_limits = true});
  const auto measure = [&](double from, double to) {
    const EdgeResult result = checked.edge({from}, {to}, {.first = true});
    expect_so(checked.checker, {from}, {to}, result, 50);
    const EdgeResult any = checked.edge({from}, {to});
    expect_so(checked.checker, {from}, {to}, any, 50);
    EXPECT_EQ(any.verdict, result.verdict);
    return result;
  };
  EXPECT_EQ(measure(0.0, -1.0).verdict, Verdict::kFree);
  const EdgeResult beyond = measure(0.0, -2.0);
  EXPECT_EQ(beyond.verdict, Verdict::kCollision);
  EXPECT_NEAR(beyond.free_until, 0.5, 1e-9);
  EXPECT_LE(beyond.free_until, 0.5);
  EXPECT_NEAR(measure(0.0, 2.0).free_until, 0.3, 1e-3) << "at the post";
  EXPECT_EQ(measure(-1.5, 0.0).free_until, 0.0);
  EXPECT_EQ(measure(-1.0, -1.5).free_until, 0.0);
}

// Solids of other kinds in the way of a sphere on a slide that turns.
TEST(RobotCheckerEdge, StopsAtSolidsOfEveryKind) {
  RobotModel robot("base");
  robot.add_link("slide", "base", sliding(-9, 9));
  robot.add_link("spindle", "slide", wheel("", Vector3d::UnitX()));
  robot.attach("spindle", one_sphere_tree({0, 0, 0}, 0.05));
  const std::vector<std::pair<ObstacleShape, double>> shapes = {
      {Primitive(Box{{0.2, 1, 1}}), 0.1},
      {Primitive(SolidSphere{0.3}), 0.3},
      {Primitive(Cylinder{0.25, 1.0}), 0.25},
      {Primitive(Capsule{0.2, 1.0}), 0.2},
      {std::make_shared<const SolidMesh>(box_mesh(Vector3d(-0.15, -1, -1), Vector3d(0.15, 1, 1))),
       0.15},
      {one_sphere_tree({0, 0, 0}, 0.4), 0.4},
  };
  for (const auto& [shape, half] : shapes) {
    RobotScene scene(robot);
    scene.add("thing", shape, Pose::from_translation({2, 0, 0}));
    Checked checked(scene);
    const Configuration from = {0.0, 0.0};
    const Configuration to = {4.0, 20.0};
    const EdgeResult result = checked.edge(from, to, {.first = true});
    EXPECT_EQ(result.verdict, Verdict::kCollision) << half;
    EXPECT_NEAR(result.free_until, (2.0 - half - 0.05) / 4.0, 1e-4);
    expect_so(checked.checker, from, to, result, 500);
    const auto met =
        checked.explain(checked.checker.configuration_on_edge(from, to, result.contact_at));
    ASSERT_EQ(met.size(), 1U) << half;
    EXPECT_EQ(met[0].second.name, "thing");
    // Wholly inside, far from any surface, is a contact as well.
    EXPECT_FALSE(checked.free(Configuration{2.0, 0.0}));
    const auto told = checked.explain(Configuration{2.0, 0.0});
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].first.name, "spindle");
    EXPECT_EQ(told[0].second.name, "thing");
    EXPECT_EQ(told[0].second.kind, CheckedBody::Kind::kObstacle);
    EXPECT_GT(told[0].overlap_depth, 0.05);
    // Bounds of the gap, from in front of it.
    const RobotClearance clearance = checked.clearance(Configuration{1.0, 3.0});
    EXPECT_LE(clearance.lower, 0.95 - half);
    EXPECT_NEAR(clearance.lower, 0.95 - half, 1e-6);
    EXPECT_NEAR(clearance.upper, 0.95 - half, 1e-6);
    scene.set_padding("spindle", "thing", 0.1);
    Checked padded(scene);
    EXPECT_NEAR(padded.checker.measure_edge(from, to, padded.scratch), (1.85 - half) / 4.0, 1e-4);
  }
  RobotScene floor(robot);
  floor.add("floor", Primitive(HalfSpace{}),
            Pose(Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * kPi, Vector3d::UnitY())),
                 Vector3d(1.5, 0, 0)));
  const EdgeResult result = Checked(floor).edge({0.0, 0.0}, {4.0, 9.0}, {.first = true});
  EXPECT_NEAR(result.free_until, 1.45 / 4.0, 1e-4);
}

TEST(RobotCheckerEdge, ManyAnswerAsOne) {
  Random random(seeded(84));
  const auto [scene, oracle] = random_scene(random);
  Checked checked(scene);
  const RobotChecker& checker = checked.checker;
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
    const EdgeResult one = checked.edge(points[i], points[i + 1], {.first = true});
    EXPECT_EQ(results[i].verdict, one.verdict);
    EXPECT_EQ(results[i].free_until, one.free_until);
    EXPECT_EQ(results[i].contact_at, one.contact_at);
  }
  EXPECT_THROW((void)checker.check_edges(all.first(variables), all, scratches), Error);
  EXPECT_THROW((void)checker.check_edges(all, all, {}), Error);
}

TEST(RobotCheckerEdge, BudgetsLeaveTheAnswerOpen) {
  RobotModel robot = one_arm(wheel(), {1, 0, 0}, 0.01);
  robot.add_link("b", "base", wheel());
  robot.attach("b", one_sphere_tree({1, 0, 0.0202}, 0.01));
  RobotScene scene(robot);
  scene.add("post", one_sphere_tree({-1, 0, 0.0404}, 0.01), Pose());
  const Configuration from = {0.5, 2.0};
  const Configuration to = {4.0, -3.0};
  for (const bool is_met : {false, true}) {
    if (is_met) scene.move("post", Pose::from_translation({0, 0, -0.0404}));
    Checked checked(scene);
    EdgeRequest request{.resolution = is_met ? 1e-9 : 1e-5, .first = is_met};
    const EdgeResult all = checked.edge(from, to, request);
    EXPECT_EQ(all.verdict, is_met ? Verdict::kCollision : Verdict::kFree);
    for (std::uint64_t budget = 0; budget < all.configurations; ++budget) {
      request.max_configurations = budget;
      const EdgeResult result = checked.edge(from, to, request);
      EXPECT_NE(result.verdict, Verdict::kFree);
      EXPECT_LE(result.configurations, budget);
      // A contact that was found counts, however short the budget for what lies before it.
      EXPECT_EQ(result.verdict == Verdict::kCollision, is_met && result.contact_at <= 1.0);
      expect_so(checked.checker, from, to, result, 20);
    }
  }
}

// A long arm with a small sphere at its end, and spheres in its way or beside it.
Checked long_arm_among(const std::vector<Sphere>& spheres) {
  std::vector<PlacedTree> obstacles;
  for (const Sphere& sphere : spheres) {
    obstacles.push_back({one_sphere_tree(sphere.center, sphere.radius)});
  }
  return Checked(obstacle_checker(one_arm(wheel(), {10, 0, 0}, 1e-3), obstacles));
}

Vector3d at_angle(double angle) {
  return {10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0};
}

// Halved as often as can be, near the start and then ever closer to a contact.
TEST(RobotCheckerEdge, EndsAtAnyResolution) {
  for (const double angle : {0.5, 1e-9, 1e-15, 3.0}) {
    Checked checked = long_arm_among({{at_angle(angle + 2e-4), 1e-3}});
    for (const double resolution : {1e-12, 1e-300, std::numeric_limits<double>::denorm_min()}) {
      const EdgeResult result =
          checked.edge({0.0}, {3.0}, {.resolution = resolution, .first = true});
      EXPECT_NE(result.verdict, Verdict::kFree);
      EXPECT_NEAR(result.free_until * 3.0, angle, 1e-6);
      EXPECT_LE(result.free_until * 3.0, angle + 1e-9);
    }
  }
}

// Past a sphere that is touched at the closest approach only: free up to where the resolution ends.
TEST(RobotCheckerEdge, IsFreeUpToWhereItGrazes) {
  Checked checked(obstacle_checker(one_arm(sliding(0, 0), {0, 0, 0}, 1.0),
                                   {{one_sphere_tree({0, 0, 2}, 1.0)}}));
  for (const double resolution : {1e-2, 1e-3, 1e-4}) {
    const EdgeResult result =
        checked.edge({-1.0}, {2.0}, {.resolution = resolution, .first = true});
    EXPECT_NE(result.verdict, Verdict::kFree);
    EXPECT_NEAR(3.0 * result.free_until, 1.0, 3.0 * resolution);
  }
}

TEST(RobotCheckerEdge, TakesAnyContactUnlessAskedForTheFirst) {
  Checked checked = long_arm_among({{at_angle(0.5), 0.01}, {at_angle(1.5), 0.01}});
  const EdgeResult any = checked.edge({0.0}, {3.0});
  EXPECT_EQ(any.verdict, Verdict::kCollision);
  const EdgeResult first = checked.edge({0.0}, {3.0}, {.first = true});
  EXPECT_EQ(first.verdict, Verdict::kCollision);
  EXPECT_NEAR(first.contact_at, 0.5 / 3.0, 1e-3);
  EXPECT_NEAR(first.free_until, (0.5 - 0.0011) / 3.0, 1e-4);
  EXPECT_LE(any.configurations, first.configurations);
}

TEST(RobotCheckerEdge, EndsCountAndStandingStill) {
  Checked beside = long_arm_among({{{0, 10, 0.0022}, 1e-3}});
  EXPECT_EQ(beside.edge({0.0}, {0.0}).verdict, Verdict::kFree);
  EXPECT_NE(beside.edge({0.0}, {3.0}, {.resolution = 1e-2}).verdict, Verdict::kCollision);
  EXPECT_EQ(beside.edge({0.0}, {3.0}, {.resolution = 1e-4}).verdict, Verdict::kFree);
  Checked touched = long_arm_among({{{10, 0, 0}, 1e-3}});
  const EdgeResult at_once = touched.edge({0.0}, {3.0}, {.first = true});
  EXPECT_EQ(at_once.verdict, Verdict::kCollision);
  EXPECT_EQ(at_once.free_until, 0.0);
  EXPECT_EQ(touched.edge({0.0}, {0.0}).verdict, Verdict::kCollision);
  const EdgeResult backwards = touched.edge({3.0}, {0.0}, {.first = true});
  EXPECT_EQ(backwards.verdict, Verdict::kCollision);
  EXPECT_GT(backwards.free_until, 0.999);
}

// Sweeps the arm of a robot past an obstacle.
Verdict swept(const RobotScene& scene) {
  return Checked(scene).edge({-1.0}, {1.0}).verdict;
}

// A checker keeps nothing of what stood in a tree or a mesh before it was assigned to, although the
// robot keeps what was computed of it for the next one.
TEST(RobotCheckerEdge, WhatWasAssignedToAnObstacleCounts) {
  const auto mesh_at = [](double x) {
    return TriangleMesh{{{x, 0, 0}, {x + 0.1, 0, 0}, {x, 0.1, 0}, {x, 0, 0.1}},
                        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  };
  const auto tree = std::make_shared<SphereTree>(*one_sphere_tree({9, 0, 0}, 0.1));
  const auto mesh = std::make_shared<SolidMesh>(mesh_at(9.0));
  RobotScene of_tree(one_arm(turning(-3.0, 3.0), {1, 0, 0}, 0.1));
  of_tree.add("post", std::shared_ptr<const SphereTree>(tree));
  of_tree.attach("tool", "arm", one_sphere_tree({1.5, 0, 0}, 0.1));
  RobotScene of_mesh = of_tree;
  of_mesh.remove("post");
  of_mesh.add("post", std::shared_ptr<const SolidMesh>(mesh));
  EXPECT_EQ(swept(of_tree), Verdict::kFree);
  EXPECT_EQ(swept(of_mesh), Verdict::kFree);
  *tree = refit(std::move(*tree), std::vector<Sphere>{{{1, 0, 0}, 0.1}});
  *mesh = SolidMesh(mesh_at(1.0));
  EXPECT_EQ(swept(of_tree), Verdict::kCollision);
  EXPECT_EQ(swept(of_mesh), Verdict::kCollision);
}

// Spheres around right triangles do not tell where the right angle is, on which it may depend
// whether a surface is closed.
TEST(RobotCheckerEdge, TheInsideOfWhatWasAssignedToAnObstacleCounts) {
  const TriangleMesh closed = box_mesh(Vector3d::Constant(-8), Vector3d::Constant(8));
  TriangleMesh open = closed;
  Eigen::Vector3i& triangle = open.triangles.front();
  const auto corner = [&](int k) { return closed.vertices[static_cast<std::size_t>(triangle[k])]; };
  for (int k = 0; k < 3; ++k) {
    const Vector3d middle = 0.5 * (corner((k + 1) % 3) + corner((k + 2) % 3));
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
  RobotScene scene(one_arm(turning(-3.0, 3.0), {1, 0, 0}, 0.1));
  scene.add("shell", std::shared_ptr<const SolidMesh>(mesh));
  EXPECT_EQ(swept(scene), Verdict::kFree);
  *mesh = SolidMesh(closed);
  EXPECT_EQ(swept(scene), Verdict::kCollision);
}

// Motions past and through thin solids and other links, made so that they come closest, or touch,
// at a known place in between: judged by plain distances under the poses of forward_kinematics().

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
  const Configuration from = random_configuration(random, robot, 3.0);
  const double size = std::pow(10.0, random.between(-2.0, 1.3));
  const Configuration to = moved(from, random_configuration(random, robot, size));
  return {from, to, random.between(0.1, 0.9)};
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

double gap_to(const SphereRobot& robot, const std::vector<Static>& solids,
              const Configuration& at) {
  const std::vector<Vector3d> centers = placed(robot, at);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [solid, pose] : solids) {
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const Vector3d p = pose.matrix().transpose() * (centers[i] - pose.translation());
      least = std::min(
          least, static_cast<double>(distance_to(solid, p.cast<Wide>())) - robot.spheres[i].radius);
    }
  }
  return least;
}

// In the way of the last link's sphere, at some place, is a solid, or a sphere that another link
// carries.
TEST(RobotEdgePasses, NothingIsPassedThrough) {
  Random random(311);
  int tested = 0;
  int found = 0;
  const int cases = effort(7000, 700);
  for (int n = 0; n < cases; ++n) {
    const bool is_carried = n % 2 == 0;
    const SphereRobot robot = random_sphere_robot(random, is_carried);
    const int last = static_cast<int>(robot.spheres.size()) - 1;
    const int other = is_carried ? random.whole(0, last - 1) : 0;
    if (!moves_against(robot.model, last, other)) continue;
    ++tested;
    const Move move = random_move(random, robot.model);
    const Configuration between = on_the_way(move.from, move.to, move.between);
    const Vector3d center = placed(robot, between).back();
    const double radius = robot.spheres.back().radius;
    std::vector<Static> solids;
    RobotScene scene = scene_without_self_tests(robot.model);
    if (is_carried) {
      const double size = std::pow(10.0, random.between(-5.0, -1.0));
      const double apart = (size + radius) * random.between(0.0, 0.9999);
      std::vector<Pose> poses;
      forward_kinematics(robot.model, between, poses);
      const auto index = static_cast<std::size_t>(other);
      const Vector3d trap = center + apart * random.direction();
      scene.attach("trap", robot.model.links()[index].name,
                   one_sphere_tree(poses[index].inverse() * trap, size));
    } else {
      solids.push_back(solid_beside(random, center, radius, -radius * random.between(1e-6, 1.0)));
      scene.add("trap", solids[0].solid, solids[0].world_from_solid);
    }
    Checked checked(scene);
    ASSERT_FALSE(checked.free(between)) << n;
    const EdgeResult result =
        checked.edge(move.from, move.to, {.resolution = 1e-3, .first = n % 4 < 2});
    ASSERT_NE(result.verdict, Verdict::kFree) << n;
    ASSERT_LE(result.free_until, move.between) << n;
    found += result.verdict == Verdict::kCollision ? 1 : 0;
    if (is_carried) continue;
    const auto hits = [&](const Configuration& at) { return gap_to(robot, solids, at) <= 1e-12; };
    expect_so(hits, move.from, move.to, result, effort(20, 10));
    if (HasFatalFailure()) return;
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
    RobotScene scene = scene_without_self_tests(robot.model);
    for (const Static& solid : solids) {
      scene.add(std::to_string(scene.obstacles().size()), solid.solid, solid.world_from_solid);
    }
    Checked checked(scene);
    const double resolution = 1e-3;
    const EdgeResult result =
        checked.edge(move.from, move.to, {.resolution = resolution, .first = true});
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
  RobotScene scene(one_arm(sliding(-90, 90), {0, 0, 0.1}, 0.05));
  scene.add("floor", Primitive(Box{{200, 1, 0.02}}), Pose::from_translation({0, 0, 0.0394}));
  Checked checked(scene);
  const auto check = [&](double resolution) {
    return checked.edge({-80.0}, {80.0}, {.resolution = resolution});
  };
  EXPECT_EQ(check(1e-4).verdict, Verdict::kFree);
  // Eight middles in single precision, and the eight parts once more in double.
  EXPECT_LE(check(1e-4).configurations, 72U);
  EXPECT_EQ(check(1e-2).verdict, Verdict::kFree) << "at a gap of 0.6 mm";
  scene.move("floor", Pose::from_translation({0, 0, 0.0401}));
  EXPECT_EQ(Checked(scene).edge({-80.0}, {80.0}).verdict, Verdict::kCollision);
}

// Motions on which continuous joints turn the shorter way, against many configurations on the way
// that std::remainder() finds, and against where contacts are known by hand.

EdgeRequest by(ContinuousMotion continuous) {
  return {.resolution = 1e-3, .first = true, .continuous = continuous};
}

// A sphere that a continuous joint swings about the base, and one that stands at an angle.
Checked swing_and_post(double angle) {
  RobotScene scene(one_arm(wheel("swing"), {1.0, 0.0, 0.0}, 0.01));
  scene.add("post", one_sphere_tree({std::cos(angle), std::sin(angle), 0.0}, 0.01));
  return Checked(scene);
}

TEST(RobotShortestEdge, TheWayThatIsStatedIsProved) {
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  const auto verdict = [&](double angle, ContinuousMotion continuous) {
    return swing_and_post(angle).edge(from, to, by(continuous)).verdict;
  };
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kAsGiven), Verdict::kCollision);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kAsGiven), Verdict::kFree);
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kShortest), Verdict::kFree);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kShortest), Verdict::kCollision);
  Checked checked = swing_and_post(0.0);
  const RobotChecker& checker = checked.checker;
  EXPECT_EQ(checker.configuration_on_edge(from, to, 0.5), Configuration{0.0});
  EXPECT_NEAR(checker.configuration_on_edge(from, to, 0.5, ContinuousMotion::kShortest)[0], kPi,
              1e-14);
  EXPECT_THROW(checker.configuration_on_edge(from, to, std::numeric_limits<double>::infinity()),
               Error);
  EXPECT_THROW(checker.configuration_on_edge({}, to, 0.5), Error);
  EXPECT_EQ(checked.edge(from, to).verdict, Verdict::kCollision) << "by default";
  EXPECT_NEAR(checker.measure_edge(from, to, checked.scratch), 0.5, 0.01);
  EXPECT_EQ(checker.measure_edge(from, to, checked.scratch, 1e-3, ContinuousMotion::kShortest),
            1.0);
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
Checked random_arm(Random& random) {
  RobotModel robot("base");
  robot.add_link("upper", "base", wheel("swing", {0.1, 0.2, 1.0}));
  Joint turn = wheel("turn", {0.3, 1.0, 0.2});
  Joint third = wheel("wheel", {1.0, 0.0, 0.5});
  turn.parent_from_joint = third.parent_from_joint = Pose::from_translation({0.6, 0.0, 0.0});
  robot.add_link("lower", "upper", turn);
  robot.add_link("wheel", "lower", third);
  robot.add_link("slider", "base", sliding(-9.0, 9.0, "slide", Vector3d::UnitZ()));
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
  return Checked(scene);
}

TEST(RobotShortestEdge, WhatIsProvedFreeIsFree) {
  Random random(seeded(91));
  VerdictCounts counts;
  int other_way = 0;
  for (int n = 0; n < scaled(300, 40); ++n) {
    Checked checked = random_arm(random);
    for (int i = 0; i < 4; ++i) {
      const double size = i == 0 ? 90.0 : 4.0;
      const auto anywhere = [&] {
        return Configuration{random.between(-size, size), random.between(-4.0, 4.0),
                             random.between(-0.5, 0.5)};
      };
      const Configuration from = anywhere();
      const Configuration to = anywhere();
      Configuration end = to;
      for (std::size_t k = 0; k < 2; ++k) {
        end[k] = from[k] + std::remainder(to[k] - from[k], 2.0 * kPi);
      }
      other_way += std::abs(end[0] - to[0]) > 1.0 || std::abs(end[1] - to[1]) > 1.0 ? 1 : 0;
      const EdgeResult result = checked.edge(from, to, by(ContinuousMotion::kShortest));
      counts.count(result.verdict);
      if (result.verdict != Verdict::kCollision) {
        expect_so(checked.checker, from, end, result, effort(500, 100));
        continue;
      }
      // The contact is one of rounding only, and the ways are not the same to the last digit.
      EdgeResult before = result;
      before.verdict = Verdict::kUnknown;
      before.contact_at = std::numeric_limits<double>::infinity();
      expect_so(checked.checker, from, end, before, effort(500, 100));
      const EdgeResult other = checked.edge(from, end, by({}));
      EXPECT_NEAR(other.contact_at, result.contact_at, 1e-6);
    }
  }
  EXPECT_GT(counts.free, effort(200, 25));
  EXPECT_GT(counts.hits, effort(80, 4));
  EXPECT_GT(other_way, effort(400, 50));
}

TEST(RobotShortestEdge, RefusesWhatCannotBeSo) {
  RobotModel robot("base");
  robot.add_link("wheel", "base", wheel("lead"));
  robot.add_link("arm", "wheel", wheel("follow", Vector3d::UnitY()));
  robot.mimic("follow", "lead", 0.5);
  Checked checked{RobotScene(robot)};
  EXPECT_NO_THROW(checked.edge({3.0}, {-3.0}));
  EXPECT_NE(reason_of([&] { checked.edge({3.0}, {-3.0}, by(ContinuousMotion::kShortest)); },
                      "joint follow"),
            "nothing is wrong");
  // The shorter way leads beyond what is proved.
  Checked swing = swing_and_post(0.0);
  EXPECT_THROW(swing.edge({99.9}, {89.33}, by(ContinuousMotion::kShortest)), Error);
  EXPECT_NO_THROW(swing.edge({99.9}, {89.33}));
}

}  // namespace
}  // namespace spherule::test
