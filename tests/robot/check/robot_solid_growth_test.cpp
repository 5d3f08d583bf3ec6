// SPDX-License-Identifier: BSD-3-Clause
// The lanes of a RobotChecker do not leave out what only the growth of a solid mesh touches.

#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "tests/collide/trees.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace spherule::test::robot_solid_growth_test {
namespace {

// A body on a line through the middle of a sphere of fine triangles, far smaller than the growth.
TEST(RobotSolidGrowth, TouchesWithinTheGrowth) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -9, .upper = 9});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 1e-3));
  TriangleMesh mesh = icosphere(4);
  mesh.vertex_error = 0.5;
  for (const double offset : {0.0, 7.0}) {
    RobotScene scene(robot);
    scene.add("solid", std::make_shared<const SolidMesh>(mesh),
              Pose::from_translation({offset, 0, 0}));
    for (const InstructionSet set : instruction_sets()) {
      const RobotChecker checker = scene.snapshot({.instructions = set});
      RobotChecker::Scratch scratch(checker);
      for (const double at : {1.2, 1.3, 1.4, 1.45}) {
        const std::vector<double> from = {offset - at};
        const std::vector<double> to = {offset - at - 0.01};
        EXPECT_FALSE(checker.check_config(from, scratch)) << at;
        EXPECT_NE(checker.check_edge(from, to, scratch).verdict, Verdict::kFree) << at;
        const std::vector<double> many(16, offset - at);
        std::vector<std::uint8_t> free(16, 2);
        checker.check_configs(many, scratch, free);
        EXPECT_EQ(free, std::vector<std::uint8_t>(16, 0)) << at;
      }
      const std::vector<double> away = {offset - 1.6};
      EXPECT_TRUE(checker.check_config(away, scratch));
    }
  }
}

}  // namespace
}  // namespace spherule::test::robot_solid_growth_test
