// SPDX-License-Identifier: BSD-3-Clause
// Angles less whole turns, against 100 digits of 2 pi.

#include "robot/model/shortest_motion.h"

#include "base/error.h"
#include "robot/model/link_paths.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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
  robot.add_link("slider", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -9.0, .upper = 9.0});
  robot.add_link("wheel", "slider", {.name = "lead", .type = JointType::kContinuous});
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
    try {
      ShortestMotion(with_follower(follower, multiplier)).require();
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), "joint follow");
      EXPECT_NE(error.reason().find("lead"), std::string::npos) << error.reason();
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(JointType::kContinuous, 3.0));
  EXPECT_TRUE(refused(JointType::kContinuous, 0.5));
  EXPECT_TRUE(refused(JointType::kContinuous, 2.0 + 1e-15));
  EXPECT_TRUE(refused(JointType::kRevolute, 1.0));
  EXPECT_TRUE(refused(JointType::kPrismatic, 1.0));
  // Of a joint with limits no whole turns are taken off, whatever follows it.
  RobotModel robot("base");
  robot.add_link("a", "base",
                 {.name = "a", .type = JointType::kRevolute, .lower = -9.0, .upper = 9.0});
  robot.add_link("b", "a", {.name = "b", .type = JointType::kContinuous});
  robot.mimic("b", "a", 0.5);
  EXPECT_NO_THROW(ShortestMotion(robot).require());
  std::vector<double> end;
  EXPECT_EQ(ShortestMotion(robot).end_of(std::vector{3.0}, std::vector{-3.0}, end)[0], -3.0);
}

TEST(ShortestMotion, SaysSoWhereItsContentWasMoved) {
  ShortestMotion motion(with_follower(JointType::kContinuous, 1.0));
  const ShortestMotion other = std::move(motion);
  std::vector<double> end;
  // NOLINTNEXTLINE(bugprone-use-after-move)
  EXPECT_THROW(motion.end_of(std::vector{0.0, 3.0}, std::vector{0.0, -3.0}, end), Error);
  EXPECT_GT(other.end_of(std::vector{0.0, 3.0}, std::vector{0.0, -3.0}, end)[1], 3.0);
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
