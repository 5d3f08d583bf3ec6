// SPDX-License-Identifier: BSD-3-Clause
// Motions past and through thin solids and other links, made so that they come closest, or touch,
// at a known place in between: judged by plain distances under the poses of forward_kinematics().

#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/edge_oracle.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <variant>
#include <vector>

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
