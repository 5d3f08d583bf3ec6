// SPDX-License-Identifier: BSD-3-Clause
// Joints that follow others: the model, and motions of those that follow fast. Every check of
// random robots has some that follow others, too (checked_scene.h).

#include "base/error.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// Joints a, b, c, d that turn one behind the other, and f that is fixed.
RobotModel chain() {
  RobotModel robot("0");
  robot.add_link("1", "0", {.name = "a", .type = JointType::kRevolute});
  robot.add_link("2", "1", {.name = "b", .type = JointType::kContinuous});
  robot.add_link("3", "2", {.name = "f"});
  robot.add_link("4", "3", {.name = "c", .type = JointType::kPrismatic});
  robot.add_link("5", "4", {.name = "d", .type = JointType::kRevolute});
  return robot;
}

TEST(Mimic, ChainsAreMultipliedOutInAnyOrder) {
  RobotModel robot = chain();
  EXPECT_FALSE(robot.has_mimics());
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{0, 1, 3, 4}));
  robot.mimic("a", "c", 2.0, 1.0);
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 3, 4}));
  robot.mimic("c", "d", -3.0, 5.0);
  EXPECT_TRUE(robot.has_mimics());
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 4}));
  const Joint& a = robot.joints()[0];
  EXPECT_EQ(a.mimics, 3);
  EXPECT_EQ(a.variable, 1);
  EXPECT_EQ(a.multiplier, -6.0);
  EXPECT_EQ(a.offset, 11.0);
  const std::vector<double> configuration = {0.25, 2.0};
  EXPECT_EQ(a.position(configuration), -1.0);
  EXPECT_EQ(robot.joints()[1].position(configuration), 0.25);
  EXPECT_EQ(robot.joints()[2].position(configuration), 0.0);
  EXPECT_EQ(robot.joints()[3].position(configuration), -1.0);
  EXPECT_EQ(robot.joints()[4].position(configuration), 2.0);
  robot.add_link("6", "0", {.name = "e", .type = JointType::kRevolute});
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 4, 5}));
  EXPECT_EQ(robot.joints()[0].multiplier, -6.0);
}

TEST(Mimic, RefusesWhatIsNoMimic) {
  RobotModel robot = chain();
  robot.mimic("a", "b");
  robot.mimic("b", "c");
  EXPECT_THROW(robot.mimic("c", "a"), Error) << "a cycle";
  EXPECT_THROW(robot.mimic("d", "d"), Error);
  EXPECT_THROW(robot.mimic("a", "c"), Error) << "twice";
  EXPECT_THROW(robot.mimic("x", "c"), Error);
  EXPECT_THROW(robot.mimic("d", "x"), Error);
  EXPECT_THROW(robot.mimic("d", ""), Error);
  EXPECT_THROW(robot.mimic("f", "c"), Error) << "it is fixed";
  EXPECT_THROW(robot.mimic("d", "f"), Error);
  EXPECT_THROW(robot.mimic("d", "c", std::nan("")), Error);
  EXPECT_THROW(robot.mimic("d", "c", 1.0, std::numeric_limits<double>::infinity()), Error);
  robot.mimic("d", "a", 1e200);
  EXPECT_THROW(robot.mimic("c", "x"), Error);
  RobotModel large = chain();
  large.mimic("a", "b", 1e200);
  EXPECT_THROW(large.mimic("b", "c", 1e200), Error) << "an infinite factor";
  EXPECT_EQ(large.variable_count(), 3) << "what is refused changes nothing";
  EXPECT_EQ(large.joints()[0].multiplier, 1e200);
}

// In time that grows with the square of their length, whichever joint is told first.
TEST(Mimic, ChainsMayBeLong) {
  constexpr int kJoints = 1500;
  const auto name = [](int i) { return "j" + std::to_string(i); };
  for (const bool is_leader_first : {true, false}) {
    RobotModel robot("0");
    for (int i = 0; i < kJoints; ++i) {
      robot.add_link(std::to_string(i + 1), std::to_string(i),
                     {.name = name(i), .type = JointType::kRevolute});
    }
    for (int i = 1; i < kJoints; ++i) {
      const int joint = is_leader_first ? i : kJoints - i;
      robot.mimic(name(joint), name(joint - 1), -1.0, 0.5);
    }
    EXPECT_EQ(robot.variable_count(), 1);
    EXPECT_EQ(robot.joints().back().multiplier, -1.0);
    EXPECT_EQ(robot.joints().back().offset, 0.5);
    EXPECT_EQ(robot.joints()[kJoints - 2].offset, 0.0);
  }
}

// A base that carries a handle without spheres, and an arm of ten metres that turns with it at
// multiplier * handle + offset, among one sphere.
Checked arm_on_handle(double multiplier, double offset, const Eigen::Vector3d& center,
                      double radius) {
  RobotModel robot = one_arm(wheel("arm"), {10, 0, 0}, 1e-3);
  robot.add_link("handle", "base", sliding(-99, 99, "handle"));
  robot.mimic("arm", "handle", multiplier, offset);
  return Checked(obstacle_checker(robot, {{one_sphere_tree(center, radius)}}));
}

// The obstacle stands where the arm gets on the way.
TEST(Mimic, FastFollowersDoNotPassThrough) {
  Random random(85);
  for (int i = 0; i < effort(300, 30); ++i) {
    const double angle = random.between(-3.0, 3.0);
    const Eigen::Vector3d center(10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0);
    // From nearly standing to many turns while the handle moves a little, with offsets that cancel.
    const double multiplier = std::pow(10.0, random.between(-1.0, 4.0));
    const double handle = random.between(-90.0, 90.0);
    const double offset = angle - multiplier * handle;
    const double size = std::pow(10.0, random.between(-6.0, -2.0));
    Checked checked = arm_on_handle(multiplier, offset, center, size);
    const double reach = std::min(5.0, 30.0 / multiplier);
    const double before = random.between(0.01, 1.0) * reach;
    const double after = random.between(0.01, 1.0) * reach;
    const EdgeResult result = checked.edge({handle - before}, {handle + after}, {.first = true});
    ASSERT_NE(result.verdict, Verdict::kFree);
    // The first of many turns.
    const double swept = multiplier * before;
    const double turn = 2.0 * std::numbers::pi;
    const double met = (swept - std::floor(swept / turn) * turn) / (multiplier * (before + after));
    const double near = (1e-3 + size + 1e-4) / (multiplier * (before + after)) + 1e-9;
    EXPECT_LE(result.free_until, met + near);
    EXPECT_GE(result.free_until, met - near);
  }
}

// In the middle of the motion the arm touches by so little that single precision is uncertain: for
// the configuration there, of which the arm's position comes first among the positions.
TEST(Mimic, DoubtsOnEdgesAreSettledWhereTheyAre) {
  Random random(88);
  for (int i = 0; i < effort(100, 20); ++i) {
    const double handle = random.between(-3.0, 3.0);
    const double multiplier = random.between(1.0, 3.0);
    const double angle = random.between(-3.0, 3.0);
    const Eigen::Vector3d center(10.0 * std::cos(angle), 10.0 * std::sin(angle), 3e-3 - 1e-9);
    Checked checked = arm_on_handle(multiplier, angle - multiplier * handle, center, 2e-3);
    const double before = random.between(0.01, 0.5);
    const EdgeResult result =
        checked.edge({handle - before}, {handle + before}, {.resolution = 1e-2});
    ASSERT_EQ(result.verdict, Verdict::kCollision);
    ASSERT_EQ(result.contact_at, 0.5);
  }
}

// A sphere that two followers move along a line, with multipliers and offsets so large that the
// computed positions are up to a millimetre beside it, where obstacles stand.
TEST(Mimic, RoundingDoesNotHideContactsOnEdges) {
  Random random(87);
  int free = 0;
  int beside = 0;
  for (int i = 0; i < effort(200, 20); ++i) {
    const double gap = random.between(0.0, i % 2 == 0 ? 3e-3 : 0.2);
    RobotModel robot("base");
    robot.add_link("handle", "base", sliding(0, 0, "handle"));
    robot.add_link("x", "base", sliding(0, 0, "x"));
    robot.add_link("y", "x", sliding(0, 0, "y", Eigen::Vector3d::UnitY()));
    robot.attach("y", one_sphere_tree({0, 0, 0}, 0.01));
    const double handle = random.between(9.0, 15.0);
    const double to_x = random.between(0.5e12, 1e12);
    const double to_y = random.between(-1e12, 1e12);
    robot.mimic("x", "handle", to_x, -to_x * handle);
    robot.mimic("y", "handle", to_y, -to_y * handle);
    const Eigen::Vector3d beside_line = Eigen::Vector3d(-to_y, to_x, 0.0).normalized();
    Checked checked(obstacle_checker(robot, {{one_sphere_tree(beside_line * (0.51 + gap), 0.5)}}));
    const Configuration from = {handle - 1e-12};
    const Configuration to = {handle + 1e-12};
    const bool is_free = checked.edge(from, to, {.resolution = 1e-5}).verdict == Verdict::kFree;
    bool collides = false;
    for (double q = from[0]; q <= to[0]; q = std::nextafter(q, 100.0)) {
      collides = collides || !checked.free(Configuration{q});
    }
    ASSERT_FALSE(is_free && collides) << gap;
    free += is_free ? 1 : 0;
    beside += collides && gap > 3e-4 ? 1 : 0;
  }
  EXPECT_GT(beside, 0) << "contacts that the straight line is clear of, beyond single precision";
  EXPECT_GT(free, 0);
}

TEST(Mimic, PositionsBeyondTheRangeAreRefusedOnEdges) {
  RobotModel robot = one_arm(wheel("a"), {9, 0, 0}, 0.1);
  robot.add_link("b", "arm", wheel("b"));
  robot.mimic("b", "a", 10.0);
  Checked checked{RobotScene(robot)};
  EXPECT_EQ(checked.edge({0.0}, {9.9}).verdict, Verdict::kFree);
  EXPECT_THROW(checked.edge({0.0}, {10.1}), Error);
  EXPECT_TRUE(checked.free(Configuration{90.0}));
}

}  // namespace
}  // namespace spherule::test
