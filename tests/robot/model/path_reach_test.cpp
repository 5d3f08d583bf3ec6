// SPDX-License-Identifier: BSD-3-Clause
// The bounds of how fast two points of a robot approach each other, against their distances under
// forward_kinematics() all along the motion. That the kernels compute the same:
// plan_bounds_test.cpp.

#include "robot/model/kinematics.h"
#include "robot/model/link_paths.h"
#include "tests/robot/check/edge_oracle.h"
#include "tests/robot/path_bounds.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace spherule::test::path_reach_test {
namespace {

using Configuration = std::vector<double>;

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
    Configuration to = random_configuration(random, robot, 2.0);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
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
  robot.add_link("upper", "base", {.type = JointType::kContinuous});
  robot.add_link(
      "lower", "upper",
      {.type = JointType::kContinuous, .parent_from_joint = Pose::from_translation({1, 0, 0})});
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
