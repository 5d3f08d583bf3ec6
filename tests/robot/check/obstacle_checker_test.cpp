// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/collide.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// Queries a checker of every instruction set for one configuration; returns the exact answer.
bool expect_answer(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                   const std::vector<double>& configuration, ObstacleOptions options) {
  const bool expected = answer(robot, obstacles, configuration, options);
  for (const InstructionSet set : instruction_sets()) {
    options.instructions = set;
    const ObstacleChecker checker(robot, obstacles, options);
    RobotChecker::Scratch scratch(checker);
    EXPECT_EQ(checker.collides(configuration, scratch), expected);
  }
  return expected;
}

TEST(ObstacleChecker, ClearancesAreThoseOfTheExactQueries) {
  Random random(seeded(24));
  int near = 0;
  int far = 0;
  for (int i = 0; i < scaled(300, 25); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.3);
    const std::vector<PlacedTree> obstacles = random_obstacles(random);
    ObstacleOptions options{.world_from_root = random_root(random, 3.0)};
    std::deque<ObstacleChecker> checkers;
    for (const InstructionSet set : instruction_sets()) {
      options.instructions = set;
      checkers.emplace_back(robot, obstacles, options);
    }
    for (int k = 0; k < 10; ++k) {
      const std::vector<double> configuration =
          random_configuration(random, robot, k == 0 ? 300.0 : 3.2);
      std::vector<Pose> poses;
      forward_kinematics(robot, configuration, poses, options.world_from_root);
      double lower = std::numeric_limits<double>::infinity();
      for (std::size_t link = 0; link < robot.links().size(); ++link) {
        for (const auto& tree : robot.links()[link].trees) {
          for (const PlacedTree& other : obstacles) {
            lower = std::min(
                lower, distance(*tree, poses[link], *other.tree, other.world_from_tree).lower);
          }
        }
      }
      // Anywhere, or as near the gap as single precision cannot tell, or can just.
      double clearance = random.between(0.0, 1.0);
      if (k % 2 == 0 && lower < 1e3) {
        const double off = std::pow(10.0, random.between(-16.0, -4.0));
        clearance = std::max(0.0, lower + (k % 4 == 0 ? off : -off));
      }
      bool expected = false;
      for (std::size_t link = 0; link < robot.links().size(); ++link) {
        for (const auto& tree : robot.links()[link].trees) {
          for (const PlacedTree& other : obstacles) {
            expected = expected ||
                       within(*tree, poses[link], *other.tree, other.world_from_tree, clearance);
          }
        }
      }
      for (const ObstacleChecker& checker : checkers) {
        RobotChecker::Scratch scratch(checker);
        ASSERT_EQ(checker.within(configuration, clearance, scratch), expected)
            << i << ' ' << k << ' ' << lower << ' ' << clearance;
        for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
          EXPECT_THROW(checker.within(configuration, bad, scratch), Error);
        }
      }
      (expected ? near : far) += 1;
    }
  }
  EXPECT_GT(near, effort(300, 20));
  EXPECT_GT(far, effort(300, 20));
}

// Axes that point nearly backwards, and trees far from their frames, whose offsets cancel.
TEST(ObstacleChecker, AnswersAsTheExactQueriesDoForOddFrames) {
  Random random(seeded(23));
  int hits = 0;
  for (int i = 0; i < scaled(4000, 300); ++i) {
    RobotModel robot("base");
    const double far = std::pow(10.0, random.between(0.0, 8.0));
    std::string parent = "base";
    for (int k = 0; k < 6; ++k) {
      Joint joint{.name = "joint_" + std::to_string(k), .type = JointType::kRevolute};
      const double off = std::pow(10.0, random.between(-8.5, -5.5));
      joint.axis = {off * random.between(-1.0, 1.0), off * random.between(-1.0, 1.0), -1.0};
      joint.parent_from_joint = random.pose(0.3);
      const std::string link = "link_" + std::to_string(k);
      robot.add_link(link, parent, joint);
      parent = link;
    }
    // A link that leads the tree's offset back to the joint.
    const Eigen::Vector3d offset = far * random.point(1.0);
    robot.add_link("tool", parent,
                   {.name = "bolt", .parent_from_joint = Pose::from_translation(-offset)});
    const Sphere sphere{offset + random.point(0.2), 0.1};
    robot.attach("tool", one_sphere_tree(sphere.center, sphere.radius));
    const std::vector<double> configuration = random_configuration(random, robot, 3.2);
    std::vector<Pose> world_from_link;
    forward_kinematics(robot, configuration, world_from_link);
    const double gap =
        (random.whole(0, 1) == 0 ? 1.0 : -1.0) * std::pow(10.0, random.between(-9.0, -5.0));
    const Eigen::Vector3d away = far * random.point(1.0);
    const Eigen::Vector3d center = world_from_link.back() * sphere.center +
                                   (sphere.radius + 0.2 + gap) * random.point(1.0).normalized();
    const std::vector<PlacedTree> obstacles = {
        {one_sphere_tree(away, 0.2), Pose::from_translation(center - away)}};
    SCOPED_TRACE(testing::Message() << i << ' ' << far);
    hits += expect_answer(robot, obstacles, configuration, {}) ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, effort(1000, 100));
}

// An arm of length one about the z axis, with a sphere at its end and one at its root.
RobotModel arm() {
  RobotModel robot("base");
  robot.attach("base", one_sphere_tree({0, 0, 0}, 0.1));
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  return robot;
}

TEST(ObstacleChecker, WhatIsNotTestedIsNotFound) {
  const std::vector<PlacedTree> obstacles = {{one_sphere_tree({0, 0, 0}, 0.05), Pose()},
                                             {one_sphere_tree({0, 1, 0}, 0.05), Pose()}};
  const auto collides = [&](std::vector<UntestedPair> untested, double angle) {
    ObstacleOptions options;
    options.untested = std::move(untested);
    const ObstacleChecker checker(arm(), obstacles, options);
    RobotChecker::Scratch scratch(checker);
    return checker.collides(std::vector<double>{angle}, scratch);
  };
  constexpr double kQuarter = 1.5707963;
  EXPECT_TRUE(collides({}, 0.0));  // the base stands in the first obstacle
  EXPECT_FALSE(collides({{0, 0}}, 0.0));
  EXPECT_TRUE(collides({{0, 0}}, kQuarter));
  EXPECT_TRUE(collides({{0, 0}}, kQuarter + 100.0 * 2.0 * 3.14159265358979));
  EXPECT_FALSE(collides({{0, 0}, {1, 1}}, kQuarter));
  EXPECT_TRUE(collides({{1, 0}, {1, 1}}, kQuarter));
  EXPECT_FALSE(collides({{0, 0}, {0, 1}, {1, 0}, {1, 1}}, kQuarter));
}

TEST(ObstacleChecker, NothingToTestIsFree) {
  const ObstacleChecker no_obstacle(arm(), {});
  RobotChecker::Scratch scratch(no_obstacle);
  EXPECT_FALSE(no_obstacle.collides(std::vector<double>{1.0}, scratch));
  const ObstacleChecker no_robot(RobotModel("base"), {{one_sphere_tree({0, 0, 0}, 1.0), Pose()}});
  RobotChecker::Scratch other(no_robot);
  EXPECT_FALSE(no_robot.collides({}, other));
}

TEST(ObstacleChecker, RefusesBadInput) {
  EXPECT_THROW(ObstacleChecker(arm(), {{nullptr, Pose()}}), Error);
  const std::vector<PlacedTree> one = {{one_sphere_tree({5, 0, 0}, 1.0), Pose()}};
  const ObstacleChecker checker(arm(), one);
  RobotChecker::Scratch scratch(checker);
  for (const std::vector<double>& bad : {std::vector<double>{},
                                         {0.0, 0.0},
                                         {std::numeric_limits<double>::quiet_NaN()},
                                         {std::numeric_limits<double>::infinity()}}) {
    EXPECT_THROW(checker.collides(bad, scratch), Error);
  }
  EXPECT_FALSE(checker.collides(std::vector<double>{0.0}, scratch));
}

}  // namespace
}  // namespace spherule::test
