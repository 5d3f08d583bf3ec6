// SPDX-License-Identifier: BSD-3-Clause
// Robots of very many bodies, as no real one has: refused, or answered in time in proportion to the
// pairs.

#include "robot/check/robot_scene.h"
#include "spheretree/error.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test::robot_size_test {
namespace {

// All turn about one axis, and all hold the origin.
RobotModel star(int bodies) {
  RobotModel robot("base");
  const auto tree = one_sphere_tree({0, 0, 0}, 0.1);
  for (int i = 0; i < bodies; ++i) {
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, "base", {.name = link + "_joint", .type = JointType::kContinuous});
    robot.attach(link, tree);
  }
  return robot;
}

TEST(RobotSize, AllTouchingPairsAreToldOnce) {
  const RobotModel robot = star(120);
  const RobotChecker checker = RobotScene(robot).snapshot();
  RobotChecker::Scratch scratch(checker);
  const std::vector<double> zero(120);
  std::set<std::pair<std::string, std::string>> told;
  for (const CheckedContact& contact : checker.explain(zero, scratch)) {
    EXPECT_TRUE(told.insert(std::minmax(contact.first.name, contact.second.name)).second);
  }
  EXPECT_EQ(told.size(), 120U * 119U / 2U);
  EXPECT_FALSE(checker.check_config(zero, scratch));
}

TEST(RobotSize, TooManyPairsAreRefused) {
  const RobotScene scene(star(1025));
  EXPECT_THROW((void)scene.snapshot(), Error);
}

}  // namespace
}  // namespace spherule::test::robot_size_test
