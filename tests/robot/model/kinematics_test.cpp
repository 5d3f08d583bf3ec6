// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/kinematics.h"

#include "base/error.h"
#include "robot/model/link_paths.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/refusals.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

// The error bound of forward kinematics against 100 digits. The poses themselves against KDL:
// tests/robot/files/urdf_oracle_test.cpp.

namespace spherule::test {
namespace {

std::vector<Pose> poses_of(const RobotModel& robot, const std::vector<double>& configuration,
                           const Pose& root = {}) {
  std::vector<Pose> poses;
  forward_kinematics(robot, configuration, poses, root);
  return poses;
}

// Where a point of a link is, of the mechanism that the model stores: in 100 digits.
Vector<Real> exact_place(const RobotModel& robot, std::size_t link,
                         const std::vector<double>& configuration, const Pose& root,
                         const Eigen::Vector3d& point) {
  Vector<Real> p = exact<Real>(point);
  for (int j = robot.links()[link].parent_joint; j >= 0;) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    if (joint.moves()) {
      const Real position =
          Real(joint.multiplier) * configuration[static_cast<std::size_t>(joint.variable)] +
          joint.offset;
      const Vector<Real> given = exact<Real>(joint.axis), origin{};
      const Vector<Real> axis = plus(origin, Real(1 / sqrt(dot(given, given))), given);
      if (joint.turns()) {  // Rodrigues' formula
        const Real c = cos(position), along = dot(axis, p) * (1 - c);
        p = plus(plus(plus(origin, c, p), Real(sin(position)), cross(axis, p)), along, axis);
      } else {
        p = plus(p, position, axis);
      }
    }
    p = transform(joint.parent_from_joint, p);
    j = robot.links()[static_cast<std::size_t>(joint.parent_link)].parent_joint;
  }
  return transform(root, p);
}

double error_of(const Pose& computed, const Eigen::Vector3d& point, const Vector<Real>& place) {
  const Vector<Real> found = transform(computed, exact<Real>(point));
  return sqrt(squared_distance(found, place)).convert_to<double>();
}

TEST(Kinematics, ErrorBoundCoversTheErrorAndIsNotIdle) {
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 90; ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 10), i % 2 == 0);
    const bool has_mimics = i % 3 == 0;
    if (has_mimics) add_random_mimics(random, robot, 5.0);
    const std::vector<double> configuration =
        random_configuration(random, robot, has_mimics ? 50.0 : 100.0);
    const Pose root = random.pose(10.0);
    const std::vector<Pose> poses = poses_of(robot, configuration, root);
    const double reach = 1.5;
    const double bound = kinematics_error_bound(robot, reach, root.translation().norm() + 1e-9);
    for (std::size_t link = 1; link < poses.size(); ++link) {
      const Eigen::Vector3d point = reach * random.point(1.0).normalized() * (1.0 - 1e-12);
      const double error =
          error_of(poses[link], point, exact_place(robot, link, configuration, root, point));
      ASSERT_LE(error, bound);
      worst = std::max(worst, error / bound);
    }
  }
  EXPECT_GT(worst, 1e-3);
}

// A large offset that nearly cancels: the position's rounding is the whole error.
TEST(Kinematics, ErrorBoundCoversMimicsThatCancel) {
  Random random(6);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    RobotModel robot;
    robot.add_link("a", "base_link", sliding(0, 0, "a"));
    robot.add_link("b", "base_link", i % 2 == 0 ? wheel("b") : sliding(-1.0, 1.0, "b"));
    const double plain = kinematics_error_bound(robot, 2.0);
    const double multiplier = random.between(1e5, 1e6);
    const double variable = random.between(90.0, 99.0);
    robot.mimic("b", "a", multiplier, random.between(-90.0, 90.0) - multiplier * variable);
    const std::vector<double> configuration = {variable};
    const Eigen::Vector3d point(2.0, 0, 0);
    const double error = error_of(poses_of(robot, configuration)[2], point,
                                  exact_place(robot, 2, configuration, Pose(), point));
    ASSERT_LE(error, kinematics_error_bound(robot, 2.0));
    worst = std::max(worst, error / plain);
  }
  EXPECT_GT(worst, 10.0) << "more than the bound without mimics";
}

TEST(Kinematics, PutsTheRootWhereItIsTold) {
  Random random(3);
  const RobotModel robot = random_robot(random, 3, false);
  const Pose root = random.pose(1.0);
  const Pose first = poses_of(robot, random_configuration(random, robot, 1.0), root)[0];
  EXPECT_EQ(first.matrix(), root.matrix());
  EXPECT_EQ(first.translation(), root.translation());
}

TEST(Kinematics, RefusesABadConfiguration) {
  Random random(4);
  RobotModel robot;
  robot.add_link("arm", "base_link", {.name = "hinge", .type = JointType::kRevolute});
  std::vector<Pose> poses;
  const auto run = [&](const std::vector<double>& q) { forward_kinematics(robot, q, poses); };
  EXPECT_NO_THROW(run({1.0}));
  EXPECT_THROW(run({}), Error);
  EXPECT_THROW(run({1.0, 2.0}), Error);
  EXPECT_THROW(run({std::nan("")}), Error);
  EXPECT_THROW(run({std::numeric_limits<double>::infinity()}), Error);
  robot.add_link("slide", "arm", {.name = "rail", .type = JointType::kPrismatic});
  EXPECT_NO_THROW(run({1.0, 1e15}));
  EXPECT_THROW(run({1.0, 1.1e15}), Error);
}

}  // namespace
}  // namespace spherule::test

// Angles less whole turns, against 100 digits of 2 pi.

namespace spherule::test::shortest_motion_test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_100;

const Real kTurn = 2 * boost::math::constants::pi<Real>();

// How far `angle` is from `to` less the nearest number of whole turns.
double error_of(double angle, double to) {
  const Real turns = round((Real(to) - Real(angle)) / kTurn);
  return static_cast<double>(abs(Real(to) - turns * kTurn - Real(angle)));
}

TEST(NearestTurn, IsTheSamePostureAtMostHalfATurnAway) {
  Random random(71);
  double worst = 0.0;
  int turned = 0;
  for (int i = 0; i < effort(200000, 20000); ++i) {
    const double size = std::pow(10.0, random.between(-1.0, 2.0));
    const double from = random.between(-size, size);
    const double to = random.between(-size, size);
    const double angle = nearest_turn(from, to);
    worst = std::max(worst, error_of(angle, to));
    ASSERT_LE(std::abs(angle - from), std::numbers::pi + kTurnError);
    if (std::abs(to - from) <= std::numbers::pi) {
      ASSERT_EQ(angle, to);
    } else {
      ++turned;
      ASSERT_NE(angle, to);
    }
  }
  EXPECT_LE(worst, kTurnError);
  EXPECT_GT(worst, 0.4 * kTurnError);  // so that the bound is about this
  EXPECT_GT(turned, effort(50000, 5000));
}

TEST(NearestTurn, HalfATurnGoesAsGiven) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(nearest_turn(0.0, kPi), kPi);
  EXPECT_EQ(nearest_turn(0.0, -kPi), -kPi);
  EXPECT_LT(nearest_turn(0.0, std::nextafter(kPi, 4.0)), 0.0);
  EXPECT_GT(nearest_turn(0.0, std::nextafter(-kPi, -4.0)), 0.0);
  EXPECT_NEAR(nearest_turn(3.0, -3.0), 2.0 * kPi - 3.0, 1e-15);
  EXPECT_NEAR(nearest_turn(-99.0, 99.0), 99.0 - 64.0 * kPi, kTurnError);
}

// A continuous joint that slides along, and one that follows it as told.
RobotModel with_follower(JointType follower, double multiplier) {
  RobotModel robot("base");
  robot.add_link("slider", "base", sliding(-9.0, 9.0, "slide"));
  robot.add_link("wheel", "slider", wheel("lead"));
  robot.add_link("arm", "wheel", {.name = "follow", .type = follower, .lower = -3.0, .upper = 3.0});
  robot.mimic("follow", "lead", multiplier, 0.25);
  return robot;
}

TEST(ShortestMotion, OnlyContinuousJointsTurnOtherwise) {
  const RobotModel robot = with_follower(JointType::kContinuous, -2.0);
  const ShortestMotion motion(robot);
  EXPECT_NO_THROW(motion.require());
  EXPECT_FALSE(motion.turns(0));
  EXPECT_TRUE(motion.turns(1));
  const std::vector<double> from = {-4.0, 3.0};
  const std::vector<double> to = {4.0, -3.0};
  std::vector<double> end;
  EXPECT_EQ(motion.end_of(from, to, end)[0], 4.0);
  EXPECT_NEAR(motion.end_of(from, to, end)[1], 2.0 * std::numbers::pi - 3.0, 1e-15);
  EXPECT_THROW(motion.end_of(from, std::vector<double>{1.0}, end), Error);
  EXPECT_THROW(motion.end_of(std::vector<double>{1.0}, to, end), Error);
}

TEST(ShortestMotion, IsRefusedWhereAFollowerWouldEndElsewhere) {
  const auto refused = [](JointType follower, double multiplier) {
    const std::string reason = reason_of(
        [&] { ShortestMotion(with_follower(follower, multiplier)).require(); }, "joint follow");
    return reason.find("lead") != std::string::npos;
  };
  EXPECT_FALSE(refused(JointType::kContinuous, 3.0));
  EXPECT_TRUE(refused(JointType::kContinuous, 0.5));
  EXPECT_TRUE(refused(JointType::kContinuous, 2.0 + 1e-15));
  EXPECT_TRUE(refused(JointType::kRevolute, 1.0));
  EXPECT_TRUE(refused(JointType::kPrismatic, 1.0));
  // Of a joint with limits no whole turns are taken off, whatever follows it.
  RobotModel robot("base");
  robot.add_link("a", "base", turning(-9.0, 9.0, "a"));
  robot.add_link("b", "a", wheel("b"));
  robot.mimic("b", "a", 0.5);
  EXPECT_NO_THROW(ShortestMotion(robot).require());
  std::vector<double> end;
  EXPECT_EQ(ShortestMotion(robot).end_of(std::vector{3.0}, std::vector{-3.0}, end)[0], -3.0);
}

// What a turn is off is charged to the bound of the poses, multiplied as the joint turns by it.
TEST(ShortestMotion, RoundingOfTurnsIsCharged) {
  constexpr double kReach = 5.0;
  const auto error_with = [](double multiplier) {
    return internal::moving_pose_error(with_follower(JointType::kContinuous, multiplier), kReach,
                                       0.0, 0.0)
        .error;
  };
  EXPECT_GE(error_with(30.0) - error_with(30.5), 0.99 * 30.0 * kTurnError * kReach);
  EXPECT_GE(error_with(-3.0) - error_with(-2.0), 0.99 * kTurnError * kReach);
}

}  // namespace
}  // namespace spherule::test::shortest_motion_test
