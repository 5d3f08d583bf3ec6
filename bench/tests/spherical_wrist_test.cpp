// SPDX-License-Identifier: BSD-3-Clause
// Postures in closed form against forward kinematics.
#include "bench/scenes/spherical_wrist.h"

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spherule {
namespace {

using std::numbers::pi;

Pose flange_at(const RobotModel& robot, const ArmPositions& positions) {
  std::vector<Pose> links;
  forward_kinematics(robot, positions, links);
  return links.back() * link6_from_flange();
}

// The largest difference of an angle, whole turns left out.
double difference(const ArmPositions& a, const ArmPositions& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2.0 * pi)));
  }
  return most;
}

void expect_reached(const RobotModel& robot, const Pose& target,
                    const std::vector<ArmPositions>& postures) {
  for (const ArmPositions& posture : postures) {
    const Pose reached = flange_at(robot, posture);
    EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-6);
    EXPECT_LT((reached.matrix() - target.matrix()).cwiseAbs().maxCoeff(), 1e-6);
    for (const double angle : posture) EXPECT_LE(std::abs(angle), pi);
  }
}

// Two for the wrist where the arm is forwards or backwards alone; mostly all eight.
TEST(SphericalWrist, FindsEveryPosture) {
  const RobotModel robot = make_robot();
  test::Random random(3);
  std::size_t all = 0;
  const int cases = test::effort(5000, 500);
  for (int i = 0; i < cases; ++i) {
    ArmPositions positions;
    for (double& position : positions) position = random.between(-pi, pi);
    // Away from where two postures fall together.
    if (std::abs(std::sin(positions[4])) < 1e-3) continue;
    const Pose target = flange_at(robot, positions);
    const auto postures = inverse_kinematics_branches(robot, target);
    expect_reached(robot, target, postures);
    EXPECT_TRUE(std::any_of(postures.begin(), postures.end(), [&](const ArmPositions& posture) {
      return difference(posture, positions) < 1e-6;
    })) << i;
    for (std::size_t a = 0; a < postures.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) EXPECT_GT(difference(postures[a], postures[b]), 1e-6);
    }
    EXPECT_TRUE(postures.size() == 4 || postures.size() == 8) << postures.size();
    all += postures.size() == 8 ? 1 : 0;
  }
  EXPECT_GT(all, static_cast<std::size_t>(cases) / 4);
  EXPECT_LT(all, static_cast<std::size_t>(cases));
}

TEST(SphericalWrist, ReachesPlacesWherePosturesFallTogether) {
  const RobotModel robot = make_robot();
  const double straight = -std::atan2(1.38, 0.15);  // of the elbow
  for (const ArmPositions& positions :
       {ArmPositions{0.4, 0.3, -0.2, 1.1, 0.0, 0.7},          // the wrist stretched
        ArmPositions{0.4, 0.3, -0.2, 1.1, pi, 0.7},           // and folded
        ArmPositions{-1.0, 0.6, straight, 0.3, 0.9, -2.0},    // the arm stretched
        ArmPositions{-1.0, 0.6, straight, 0.0, 0.0, 0.0}}) {  // and the wrist
    const Pose target = flange_at(robot, positions);
    const auto postures = inverse_kinematics_branches(robot, target);
    EXPECT_GE(postures.size(), 1u);
    expect_reached(robot, target, postures);
  }
}

TEST(SphericalWrist, FindsNothingOutOfReach) {
  const RobotModel robot = make_robot();
  EXPECT_TRUE(inverse_kinematics_branches(robot, Pose::from_translation({5.0, 0.0, 0.0})).empty());
  EXPECT_TRUE(inverse_kinematics_branches(robot, Pose::from_translation({0.34, 0.0, 0.7})).empty());
}

TEST(SphericalWrist, RefusesOtherRobots) {
  EXPECT_THROW(inverse_kinematics_branches(RobotModel(), Pose()), Error);
  const RobotModel usual = make_robot();
  RobotModel robot("base");
  std::string parent = "base";
  for (int i = 0; i < kJoints; ++i) {
    const Joint& joint = usual.joints()[static_cast<std::size_t>(i)];
    Joint moved{.name = joint.name,
                .type = joint.type,
                .parent_from_joint = joint.parent_from_joint,
                .axis = joint.axis,
                .lower = joint.lower,
                .upper = joint.upper};
    if (i == 5) moved.parent_from_joint = Pose::from_translation({0.0, 0.0, 0.1});
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, parent, moved);
    parent = link;
  }
  EXPECT_THROW(inverse_kinematics_branches(robot, Pose()), Error);
}

TEST(SphericalWrist, LimitsIncludeTheirEnds) {
  const RobotModel robot = make_robot();
  ArmPositions positions{};
  EXPECT_TRUE(is_within_limits(robot, positions));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Joint& joint = robot.joints()[i];
    for (const double limit : {joint.lower, joint.upper}) {
      positions[i] = limit;
      EXPECT_TRUE(is_within_limits(robot, positions));
      positions[i] = std::nextafter(limit, 2.0 * limit);
      EXPECT_FALSE(is_within_limits(robot, positions));
    }
    positions[i] = 0.0;
  }
}

}  // namespace
}  // namespace spherule
