// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/robot_model.h"

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "robot/model/link_paths.h"
#include "robot/pairs/allowed_collisions.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/path_bounds.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace spherule::test::link_paths_test {
namespace {

// By the joints between two links, one after the other.
AllowedReason reason_of(const RobotModel& robot, int first, int second) {
  int moving = 0;
  bool are_neighbours = true;
  int link = first;
  for (const int index : internal::joints_between(robot, first, second)) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    const auto& trees = robot.links()[static_cast<std::size_t>(link)].trees;
    if (link != first && !trees.empty()) are_neighbours = false;
    link = joint.child_link == link ? joint.parent_link : joint.child_link;
    moving += joint.moves() ? 1 : 0;
  }
  EXPECT_EQ(link, second);
  return moving == 0                     ? AllowedReason::kRigid
         : moving == 1 && are_neighbours ? AllowedReason::kAdjacent
                                         : AllowedReason::kTested;
}

TEST(AllowedCollisions, WhatIsJoinedIsAllowed) {
  Random random(401);
  std::map<AllowedReason, int> counts;
  for (int n = 0; n < 100; ++n) {
    RobotModel robot = random_robot(random, random.whole(0, 12), n % 4 != 0);
    for (const Link& link : std::vector<Link>(robot.links())) {
      if (random.coin()) robot.attach(link.name, one_sphere_tree({0, 0, 0}, 0.1));
    }
    const AllowedCollisions allowed(robot);
    const int links = static_cast<int>(robot.links().size());
    for (int first = 0; first < links; ++first) {
      EXPECT_TRUE(allowed.allows(first, first));
      for (int second = 0; second < links; ++second) {
        if (first == second) continue;
        const AllowedReason expected = reason_of(robot, first, second);
        ASSERT_EQ(allowed.reason(first, second), expected) << n << ": " << first << ' ' << second;
        ASSERT_EQ(allowed.allows(first, second), expected != AllowedReason::kTested);
        ++counts[expected];
      }
    }
  }
  EXPECT_GT(counts[AllowedReason::kRigid], 300);
  EXPECT_GT(counts[AllowedReason::kAdjacent], 300);
  EXPECT_GT(counts[AllowedReason::kTested], 300);
}

// By paths for each pair, these are 9 billion joints.
TEST(AllowedCollisions, OfALongChainAreQuadraticInIt) {
  RobotModel robot("link_0");
  for (int i = 1; i < 3000; ++i) {
    robot.add_link("link_" + std::to_string(i), "link_" + std::to_string(i - 1), wheel());
  }
  const AllowedCollisions allowed(robot);
  EXPECT_EQ(allowed.reason(1500, 1501), AllowedReason::kAdjacent);
  EXPECT_EQ(allowed.reason(0, 2999), AllowedReason::kTested);
}

TEST(AllowedCollisions, RefuseARobotOfTooManyLinks) {
  RobotModel robot("link_0");
  for (std::size_t i = 1; i <= AllowedCollisions::kMaxLinks; ++i) {
    robot.add_link("link_" + std::to_string(i), "link_0", {});
  }
  EXPECT_THROW(AllowedCollisions{robot}, Error);
}

}  // namespace
}  // namespace spherule::test::link_paths_test

// The bounds of how fast two points of a robot approach each other, against their distances under
// forward_kinematics() all along the motion. That the kernels compute the same:
// tests/robot/check/plan_test.cpp.

namespace spherule::test::path_reach_test {
namespace {

struct Body {
  int link;
  Sphere sphere;
  Eigen::Vector3d point;  // in the sphere
};

Body random_body(Random& random, const RobotModel& robot) {
  const Sphere sphere{random.point(1.0), random.between(0.0, 0.3)};
  return {random.whole(0, static_cast<int>(robot.links().size()) - 1), sphere,
          sphere.center + sphere.radius * random.point(1.0).normalized()};
}

std::vector<Pose> poses_at_zero(const RobotModel& robot) {
  std::vector<Pose> poses;
  forward_kinematics(robot, std::vector<double>(static_cast<std::size_t>(robot.variable_count())),
                     poses);
  return poses;
}

// Each distance bounds every other one, by its own value and slope; the test counts how often a
// bound was nearly reached.
TEST(PathReach, BoundsHowDistancesChange) {
  Random random(321);
  int near_speed = 0;
  int near_bend = 0;
  for (int n = 0; n < effort(3000, 300); ++n) {
    RobotModel robot = random_robot(random, random.whole(1, 7), n % 2 == 0);
    if (n % 3 == 0) add_random_mimics(random, robot, 1.0);
    const Body a = random_body(random, robot);
    const Body b = random_body(random, robot);
    const bool b_is_static = b.link == 0 && n % 4 < 2;
    const Configuration from = random_configuration(random, robot, 2.0);
    const Configuration to = moved(random_configuration(random, robot, 2.0), from);
    std::vector<int> joints;
    std::vector<double> rates(robot.joints().size());
    std::vector<double> shifts(robot.joints().size());
    for (const int j : internal::joints_between(robot, a.link, b.link)) {
      const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
      if (!joint.moves()) continue;
      joints.push_back(j);
      rates[static_cast<std::size_t>(j)] = std::abs(joint.position(to) - joint.position(from));
      shifts[static_cast<std::size_t>(j)] =
          std::max(std::abs(joint.position(to)), std::abs(joint.position(from)));
    }
    const std::vector<Pose> poses = poses_at_zero(robot);
    const internal::PathReach reach =
        b_is_static
            ? internal::PathReach(robot, poses, 1e-13, joints, a.link, a.sphere)
            : internal::PathReach(robot, poses, 1e-13, joints, a.link, a.sphere, b.link, b.sphere);
    const PathBounds bounds = path_bounds(reach, !b_is_static, rates, shifts);
    std::vector<Pose> placed;
    const auto distance = [&](double t) {
      forward_kinematics(robot, on_the_way(from, to, t), placed);
      return (placed[static_cast<std::size_t>(a.link)] * a.point -
              placed[static_cast<std::size_t>(b.link)] * b.point)
          .norm();
    };
    for (int i = 0; i < 5; ++i) {
      const double middle = random.between(0.001, 0.999);
      const double step = 1e-5;
      const double there = distance(middle);
      if (there < 0.01) continue;
      const double slope = (distance(middle + step) - distance(middle - step)) / (2.0 * step);
      for (int k = 0; k < 5; ++k) {
        const double h = (k == 0 ? 0.01 : 1.0) * random.between(-middle, 1.0 - middle);
        const double lost = there - distance(middle + h);
        const double rounding = 1e-6 * std::abs(h) * (1.0 + bounds.bend) + 1e-12;
        ASSERT_LE(lost, bounds.speed * std::abs(h) + rounding) << n;
        ASSERT_LE(lost, std::abs(slope * h) + bounds.bend * h * h + rounding) << n;
        near_speed += lost > 0.5 * bounds.speed * std::abs(h) + rounding ? 1 : 0;
        near_bend += lost + slope * h > 0.3 * bounds.bend * h * h + rounding ? 1 : 0;
      }
    }
  }
  EXPECT_GT(near_speed, effort(100, 10));
  EXPECT_GT(near_bend, effort(100, 10));
}

// A stretched arm of two links of length one, seen from far behind: the two turns add up, and the
// bound of what its velocity bends by is reached.
TEST(PathReach, CountsTurnsThatAddUp) {
  RobotModel robot("base");
  robot.add_link("upper", "base", wheel());
  Joint elbow = wheel();
  elbow.parent_from_joint = Pose::from_translation({1, 0, 0});
  robot.add_link("lower", "upper", elbow);
  const std::vector<int> joints = {1, 0};
  const internal::PathReach reach(robot, poses_at_zero(robot), 1e-15, joints, 2, {{1, 0, 0}, 0.0});
  const PathBounds bounds =
      path_bounds(reach, false, std::vector<double>{1.0, 1.0}, std::vector<double>{0.0, 0.0});
  EXPECT_NEAR(bounds.speed, 3.0, 1e-6);
  EXPECT_NEAR(bounds.bend, 2.5, 1e-6);
  std::vector<Pose> placed;
  const auto distance = [&](double angle) {
    forward_kinematics(robot, Configuration{angle, angle}, placed);
    return (placed[2] * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(-1e4, 0, 0)).norm();
  };
  const double h = 0.1;
  const double lost = distance(0.0) - distance(h);
  EXPECT_LE(lost, bounds.bend * h * h);
  EXPECT_GT(lost, 0.99 * bounds.bend * h * h);
}

}  // namespace
}  // namespace spherule::test::path_reach_test

namespace spherule::test {
namespace {

TEST(RobotModel, NumbersLinksAndVariables) {
  RobotModel robot("base");
  EXPECT_EQ(robot.add_link("upper", "base", turning(0.0, 0.0, "shoulder")), 1);
  EXPECT_EQ(robot.add_link("plate", "upper", {.name = "bolt"}), 2);
  EXPECT_EQ(robot.add_link("lower", "upper", turning(0.0, 0.0, "elbow")), 3);
  EXPECT_EQ(robot.variable_count(), 2);
  EXPECT_EQ(robot.find_link("lower"), 3);
  EXPECT_EQ(robot.find_link("nothing"), -1);
  EXPECT_EQ(robot.links()[0].parent_joint, -1);
  EXPECT_EQ(robot.links()[3].parent_joint, 2);
  EXPECT_EQ(robot.joints()[1].variable, -1);
  EXPECT_EQ(robot.joints()[2].variable, 1);
  EXPECT_EQ(robot.joints()[2].parent_link, 1);
  EXPECT_EQ(robot.joints()[2].child_link, 3);
}

TEST(RobotModel, MakesTheAxisAndTheRotationUnit) {
  RobotModel robot("base");
  Joint joint = turning(0.0, 0.0, "shoulder");
  joint.axis = {1e-200, 2e-200, -2e-200};
  joint.parent_from_joint = Pose(Eigen::Quaterniond(1e200, 0.0, 1e200, 0.0), {1.0, 2.0, 3.0});
  robot.add_link("upper", "base", joint);
  const Joint& stored = robot.joints()[0];
  EXPECT_LT((stored.axis - Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0).norm(), 1e-15);
  EXPECT_NEAR(stored.parent_from_joint.rotation().norm(), 1.0, 1e-15);
  EXPECT_EQ(stored.parent_from_joint.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(RobotModel, RefusesWhatIsNoMechanism) {
  RobotModel robot("base");
  robot.add_link("upper", "base", turning(0.0, 0.0, "shoulder"));
  EXPECT_THROW(robot.add_link("upper", "base", turning(0.0, 0.0, "other")), Error);
  EXPECT_THROW(robot.add_link("base", "upper", turning(0.0, 0.0, "other")), Error);
  EXPECT_THROW(robot.add_link("lower", "upper", turning(0.0, 0.0, "shoulder")), Error);
  EXPECT_THROW(robot.add_link("lower", "nothing", turning(0.0, 0.0, "elbow")), Error);
  Joint joint = turning(0.0, 0.0, "elbow");
  joint.axis = Eigen::Vector3d::Zero();
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint.axis = {1.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint = turning(0.0, 0.0, "elbow");
  joint.lower = 1.0;
  joint.upper = -1.0;
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint.lower = -std::numeric_limits<double>::infinity();
  joint.upper = 1.0;
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  EXPECT_EQ(robot.links().size(), 2u);
  EXPECT_EQ(robot.variable_count(), 1);

  EXPECT_THROW(robot.attach("nothing", one_sphere_tree({0, 0, 0}, 0.0)), Error);
  EXPECT_THROW(robot.attach("upper", nullptr), Error);
}

}  // namespace
}  // namespace spherule::test
