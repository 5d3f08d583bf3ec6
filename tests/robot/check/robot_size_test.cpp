// SPDX-License-Identifier: BSD-3-Clause
// Robots of very many bodies, as no real one has: refused, or answered in time in proportion to the
// pairs.

#include "robot/check/robot_scene.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/refusals.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
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
    robot.add_link(link, "base", wheel(link + "_joint"));
    robot.attach(link, tree);
  }
  return robot;
}

TEST(RobotSize, AllTouchingPairsAreToldOnce) {
  constexpr int kBodies = effort(40, 15);
  Checked checked{RobotScene(star(kBodies))};
  const std::vector<double> zero(kBodies);
  std::set<std::pair<std::string, std::string>> told;
  for (const CheckedContact& contact : checked.explain(zero)) {
    EXPECT_TRUE(told.insert(std::minmax(contact.first.name, contact.second.name)).second);
  }
  EXPECT_EQ(told.size(), std::size_t{kBodies} * (kBodies - 1) / 2);
  EXPECT_FALSE(checked.free(zero));
}

std::string refusal(const RobotScene& scene) {
  return reason_of([&] { (void)scene.snapshot(); });
}

TEST(RobotSize, TooManyPairsAreRefused) {
  EXPECT_NE(refusal(RobotScene(star(1025))).find("too many pairs of bodies"), std::string::npos);
}

// Each pair moves by all joints between its bodies.
TEST(RobotSize, TooManyJointsBetweenPairsAreRefused) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  RobotModel robot("link_0");
  const auto tree = one_sphere_tree({0, 0, 0}, 0.1);
  for (int i = 1; i < 480; ++i) {
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, "link_" + std::to_string(i - 1), wheel(link + "_joint"));
    robot.attach(link, tree);
  }
  EXPECT_NE(refusal(RobotScene(robot)).find("too many joints lie between"), std::string::npos);
}

TEST(RobotSize, RegionsOfTooManySpheresAreRefused) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  RobotModel robot("base");
  Random random(19);
  robot.attach("base", std::make_shared<const SphereTree>(
                           build_tree(random_spheres(random, 300'000, 1.0, 0.1))));
  RobotScene scene(robot);
  const Sphere all{Eigen::Vector3d::Zero(), 10.0};
  for (int i = 0; i < 55; ++i) scene.define_region({"base", std::to_string(i)}, all);
  EXPECT_THROW(scene.define_region({"base", "last"}, all), Error);
}

}  // namespace
}  // namespace spherule::test::robot_size_test
