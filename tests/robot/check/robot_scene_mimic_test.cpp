// SPDX-License-Identifier: BSD-3-Clause
#include "collide/collide.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace spherule::test::robot_scene_mimic_test {
namespace {

using Configuration = std::vector<double>;

// The far end of a mimic rounds by more than the bounds for the usual range allow for.
TEST(RobotSceneMimics, FarOnesAreMetToTheLastDigits) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.name = "lead",
                  .type = JointType::kPrismatic,
                  .axis = {1, 0, 0},
                  .lower = -1.0,
                  .upper = 1.0});
  robot.add_link("a", "slide",
                 {.name = "far",
                  .type = JointType::kPrismatic,
                  .axis = {1, 2, 3},
                  .lower = -1.0,
                  .upper = 1.0});
  robot.mimic("far", "lead", 1e8);
  robot.add_link("b", "a",
                 {.name = "turn",
                  .type = JointType::kContinuous,
                  .parent_from_joint = Pose::from_translation({0.3, 0.1, 0.2}),
                  .axis = {0.3, 0.5, 0.8}});
  robot.attach("a", one_sphere_tree({0.1234, 0.2345, 0.345}, 0.1));
  robot.attach("b", one_sphere_tree({0.3, -0.2, 0.1}, 0.1));
  const Pose root(Eigen::Quaterniond(0.3, 0.5, 0.1, 0.7), {0.1, 0.2, 0.3});
  RobotScene scene(robot, root);
  AllowedCollisions allowed(robot);
  allowed.forbid("a", "b");
  scene.set_allowed_collisions(allowed);
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  std::vector<Pose> poses;
  const auto touches = [&](double lead, double turn) {
    forward_kinematics(robot, Configuration{lead, turn}, poses, root);
    return collides(*robot.links()[2].trees[0], poses[2], *robot.links()[3].trees[0], poses[3]);
  };
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    const double lead = 0.5 + 0.0024681357 * i;
    for (double turn = -3.1; turn < 3.1; turn += 0.15) {
      double in = turn;
      double out = turn + 0.15;
      if (touches(lead, in) == touches(lead, out)) continue;
      if (!touches(lead, in)) std::swap(in, out);
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (in + out);
        (touches(lead, middle) ? in : out) = middle;
      }
      ++touching;
      EXPECT_FALSE(checker.check_config(Configuration{lead, in}, scratch)) << lead << ' ' << in;
      EXPECT_EQ(checker.clearance(Configuration{lead, in}, scratch).lower, 0.0);
    }
  }
  EXPECT_GT(touching, 100);
}

}  // namespace
}  // namespace spherule::test::robot_scene_mimic_test
