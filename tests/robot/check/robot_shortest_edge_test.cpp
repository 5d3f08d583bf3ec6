// SPDX-License-Identifier: BSD-3-Clause
// Motions on which continuous joints turn the shorter way, against many configurations on the way
// that std::remainder() finds, and against where contacts are known by hand.

#include "base/error.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "tests/robot/check/edge_oracle.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test::robot_shortest_edge_test {
namespace {

constexpr double kPi = std::numbers::pi;
using Configuration = std::vector<double>;

EdgeRequest by(ContinuousMotion continuous) {
  return {.resolution = 1e-3, .first = true, .continuous = continuous};
}

// A sphere that a continuous joint swings about the base, and one that stands at an angle.
RobotChecker swing_and_post(double angle) {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "swing", .type = JointType::kContinuous});
  robot.attach("arm", one_sphere_tree({1.0, 0.0, 0.0}, 0.01));
  RobotScene scene(robot);
  scene.add("post", one_sphere_tree({std::cos(angle), std::sin(angle), 0.0}, 0.01));
  return scene.snapshot();
}

TEST(RobotShortestEdge, TheWayThatIsStatedIsProved) {
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  const auto verdict = [&](double angle, ContinuousMotion continuous) {
    const RobotChecker checker = swing_and_post(angle);
    RobotChecker::Scratch scratch(checker);
    return checker.check_edge(from, to, scratch, by(continuous)).verdict;
  };
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kAsGiven), Verdict::kCollision);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kAsGiven), Verdict::kFree);
  EXPECT_EQ(verdict(0.0, ContinuousMotion::kShortest), Verdict::kFree);
  EXPECT_EQ(verdict(kPi, ContinuousMotion::kShortest), Verdict::kCollision);
  const RobotChecker checker = swing_and_post(0.0);
  EXPECT_EQ(checker.configuration_on_edge(from, to, 0.5), Configuration{0.0});
  EXPECT_NEAR(checker.configuration_on_edge(from, to, 0.5, ContinuousMotion::kShortest)[0], kPi,
              1e-14);
  EXPECT_THROW(checker.configuration_on_edge(from, to, std::numeric_limits<double>::infinity()),
               Error);
  EXPECT_THROW(checker.configuration_on_edge({}, to, 0.5), Error);
  RobotChecker::Scratch scratch(checker);
  EXPECT_EQ(checker.check_edge(from, to, scratch).verdict, Verdict::kCollision) << "by default";
  EXPECT_NEAR(checker.measure_edge(from, to, scratch), 0.5, 0.01);
  EXPECT_EQ(checker.measure_edge(from, to, scratch, 1e-3, ContinuousMotion::kShortest), 1.0);
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
RobotChecker random_arm(Random& random) {
  RobotModel robot("base");
  const Pose shoulder = Pose::from_translation({0.6, 0.0, 0.0});
  robot.add_link("upper", "base",
                 {.name = "swing", .type = JointType::kContinuous, .axis = {0.1, 0.2, 1.0}});
  robot.add_link("lower", "upper",
                 {.name = "turn",
                  .type = JointType::kContinuous,
                  .parent_from_joint = shoulder,
                  .axis = {0.3, 1.0, 0.2}});
  robot.add_link("wheel", "lower",
                 {.name = "wheel",
                  .type = JointType::kContinuous,
                  .parent_from_joint = shoulder,
                  .axis = {1.0, 0.0, 0.5}});
  robot.add_link("slider", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -9.0, .upper = 9.0});
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
  return scene.snapshot();
}

TEST(RobotShortestEdge, WhatIsProvedFreeIsFree) {
  Random random(seeded(91));
  int free = 0;
  int hits = 0;
  int other_way = 0;
  for (int n = 0; n < scaled(300, 40); ++n) {
    const RobotChecker checker = random_arm(random);
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < 4; ++i) {
      const double size = i == 0 ? 90.0 : 4.0;
      const Configuration from = {random.between(-size, size), random.between(-4.0, 4.0),
                                  random.between(-0.5, 0.5)};
      const Configuration to = {random.between(-size, size), random.between(-4.0, 4.0),
                                random.between(-0.5, 0.5)};
      Configuration end = to;
      for (std::size_t k = 0; k < 2; ++k) {
        end[k] = from[k] + std::remainder(to[k] - from[k], 2.0 * kPi);
      }
      other_way += std::abs(end[0] - to[0]) > 1.0 || std::abs(end[1] - to[1]) > 1.0 ? 1 : 0;
      const EdgeResult result =
          checker.check_edge(from, to, scratch, by(ContinuousMotion::kShortest));
      free += result.verdict == Verdict::kFree ? 1 : 0;
      hits += result.verdict == Verdict::kCollision ? 1 : 0;
      const auto touches = [&](const Configuration& at) {
        return !checker.check_config(at, scratch);
      };
      if (result.verdict != Verdict::kCollision) {
        expect_so(touches, from, end, result, effort(500, 100));
        continue;
      }
      // The contact is one of rounding only, and the ways are not the same to the last digit.
      EdgeResult before = result;
      before.verdict = Verdict::kUnknown;
      before.contact_at = std::numeric_limits<double>::infinity();
      expect_so(touches, from, end, before, effort(500, 100));
      const EdgeResult other = checker.check_edge(from, end, scratch, by({}));
      EXPECT_NEAR(other.contact_at, result.contact_at, 1e-6);
    }
  }
  EXPECT_GT(free, effort(200, 25));
  EXPECT_GT(hits, effort(80, 4));
  EXPECT_GT(other_way, effort(400, 50));
}

TEST(RobotShortestEdge, RefusesWhatCannotBeSo) {
  RobotModel robot("base");
  robot.add_link("wheel", "base", {.name = "lead", .type = JointType::kContinuous});
  robot.add_link("arm", "wheel",
                 {.name = "follow", .type = JointType::kContinuous, .axis = {0, 1, 0}});
  robot.mimic("follow", "lead", 0.5);
  const RobotChecker checker = RobotScene(robot).snapshot();
  RobotChecker::Scratch scratch(checker);
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  EXPECT_NO_THROW(checker.check_edge(from, to, scratch));
  try {
    checker.check_edge(from, to, scratch, by(ContinuousMotion::kShortest));
    ADD_FAILURE() << "is not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "joint follow");
  }
  // The shorter way leads beyond what is proved.
  const RobotChecker swing = swing_and_post(0.0);
  RobotChecker::Scratch other(swing);
  EXPECT_THROW(swing.check_edge(Configuration{99.9}, Configuration{89.33}, other,
                                by(ContinuousMotion::kShortest)),
               Error);
  EXPECT_NO_THROW(swing.check_edge(Configuration{99.9}, Configuration{89.33}, other));
}

}  // namespace
}  // namespace spherule::test::robot_shortest_edge_test
