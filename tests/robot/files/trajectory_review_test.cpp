// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/trajectory_file.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// An elbow of -2 to 2.5 rad, a slide of +-1 m, a finger that follows it at half its position within
// 0.4 m, and a wheel that turns without limits: three numbers.
RobotModel robot_of_all_kinds() {
  RobotModel robot("base");
  robot.add_link("forearm", "base",
                 {.name = "elbow", .type = JointType::kRevolute, .lower = -2.0, .upper = 2.5});
  robot.add_link("slider", "forearm",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -1.0, .upper = 1.0});
  robot.add_link("tip", "slider",
                 {.name = "finger", .type = JointType::kPrismatic, .lower = -0.4, .upper = 0.4});
  robot.add_link("disc", "slider", {.name = "wheel", .type = JointType::kContinuous});
  robot.mimic("finger", "slide", 0.5);
  return robot;
}

// As lines 10, 20 and so on of a file.
Trajectory trajectory_of(const std::vector<std::vector<double>>& configurations) {
  Trajectory trajectory{.width = 3};
  for (const std::vector<double>& configuration : configurations) {
    trajectory.positions.insert(trajectory.positions.end(), configuration.begin(),
                                configuration.end());
    trajectory.lines.push_back(10 * (trajectory.size() + 1));
  }
  return trajectory;
}

TEST(OutsideLimits, AreCountedAndTheFirstIsNamed) {
  const RobotModel robot = robot_of_all_kinds();
  const auto outside = [&](const std::vector<std::vector<double>>& configurations) {
    return outside_limits(robot, trajectory_of(configurations));
  };
  EXPECT_EQ(outside({{2.5, 0.8, 9.0}, {-2.0, -0.8, -9.0}}).count, 0u) << "the limits are within";
  const OutsideLimits found = outside({{0, 0, 0}, {0, 0.9, 0}, {3, 0, 0}, {0, -2, 0}, {0, 0, 0}});
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.line, 20u);
  EXPECT_EQ(found.joint, "finger") << "0.9 is within those of the slide";
  EXPECT_FALSE(found.turns);
  EXPECT_EQ(found.position, 0.45);
  EXPECT_EQ(found.upper, 0.4);
  const OutsideLimits elbow = outside({{std::nextafter(2.5, 3.0), 0, 0}});
  EXPECT_EQ(elbow.count, 1u);
  EXPECT_EQ(elbow.joint, "elbow");
  EXPECT_TRUE(elbow.turns);
  EXPECT_EQ(elbow.lower, -2.0);
}

TEST(DegreesGuess, TellsDegreesFromRadians) {
  const RobotModel robot = robot_of_all_kinds();
  Random random(72);
  int told = 0;
  const int cases = effort(500, 100);
  for (int i = 0; i < cases; ++i) {
    // Large motions of all joints, in radians and in degrees.
    std::vector<std::vector<double>> radians, degrees;
    for (int k = 0; k < 20; ++k) {
      const std::vector<double> at = {random.between(-2.0, 2.5), random.between(-1.0, 1.0),
                                      random.between(-kPi, kPi)};
      radians.push_back(at);
      degrees.push_back({at[0] / kDegree, at[1], at[2] / kDegree});
    }
    EXPECT_FALSE(guess_degrees(robot, trajectory_of(radians)).looks_so);
    told += guess_degrees(robot, trajectory_of(degrees)).looks_so ? 1 : 0;
  }
  EXPECT_EQ(told, cases);
}

TEST(DegreesGuess, NeedsManyAnglesThatFitOnlySo) {
  const RobotModel robot = robot_of_all_kinds();
  const auto looks_so = [&](const std::vector<std::vector<double>>& configurations) {
    return guess_degrees(robot, trajectory_of(configurations)).looks_so;
  };
  EXPECT_TRUE(looks_so({{0, 0, 0}, {90, 0, 0}}));
  EXPECT_TRUE(looks_so({{0, 0, 180}, {0, 0, -720}}));
  EXPECT_FALSE(looks_so({{0, 0, 0}, {0, 100, 0}})) << "lengths are none";
  EXPECT_FALSE(looks_so({{200, 0, 0}, {90, 0, 0}})) << "beyond the limits as degrees, too";
  EXPECT_FALSE(looks_so({{2.6, 0, 0}, {2.7, 0, 0}})) << "slightly beyond, in radians";
  EXPECT_FALSE(looks_so({{1, 0, 7}, {2, 0, 8}, {1, 0, 3}, {2, 0, 0.1}, {2, 0, 0.1}}))
      << "a wheel that turns a little more than once";
  EXPECT_FALSE(looks_so({{0, 0, 721}})) << "a spindle";
  EXPECT_FALSE(looks_so({{0, 0, 0}}));
  const DegreesGuess guess =
      guess_degrees(robot, trajectory_of({{0, 0, 0}, {1, 0, 0}, {-90, 0, 3}, {45, 0.5, 120}}));
  EXPECT_TRUE(guess.looks_so);
  EXPECT_EQ(guess.angles, 5u);
  EXPECT_EQ(guess.beyond, 3u);
  EXPECT_EQ(guess.line, 30u);
  EXPECT_EQ(guess.joint, "elbow");
  EXPECT_EQ(guess.value, -90.0);
}

TEST(TurningMotions, AreThoseOfContinuousJoints) {
  const RobotModel robot = robot_of_all_kinds();
  const Trajectory path =
      trajectory_of({{-2, -1, 0}, {2.4, 1, 3}, {-2, 0, -3}, {0, 0, 4}, {0, 0, 4 - kPi}});
  const TurningMotions found = more_than_half_a_turn(robot, path);
  EXPECT_EQ(found.count, 2u);
  EXPECT_EQ(found.line, 20u);
  EXPECT_EQ(found.to_line, 30u);
  EXPECT_EQ(found.joint, "wheel");
  EXPECT_EQ(found.step, -6.0);
  EXPECT_NEAR(found.shorter, 2.0 * kPi - 6.0, 1e-14);
  const TurningMotions half = half_a_turn(robot, path);
  EXPECT_EQ(half.count, 1u);
  EXPECT_EQ(half.line, 40u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.1416}})).count, 1u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.1415}})).count, 1u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.14}})).count, 0u);
  EXPECT_EQ(more_than_half_a_turn(robot, trajectory_of({{0, 0, 9}})).count, 0u);
}

}  // namespace
}  // namespace spherule::test
