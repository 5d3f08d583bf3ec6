// SPDX-License-Identifier: BSD-3-Clause
// RobotChecker's fast check, configurations and motions in lanes, on every instruction set, among
// obstacles of every kind, against explain(), which makes all canonical tests one by one. More
// motions: robot_checker_edge_test.cpp.

#include "collide/meshes/solid_mesh.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace spherule::test::robot_lanes_test {
namespace {

// One for each instruction set.
std::deque<Checked> checked_of(const RobotScene& scene) {
  std::deque<Checked> result;
  for (const InstructionSet set : instruction_sets()) {
    result.emplace_back(scene, RobotCheckerOptions{.instructions = set});
  }
  return result;
}

void expect_same_answers(const RobotScene& scene, const std::vector<Configuration>& tested) {
  std::deque<Checked> checked = checked_of(scene);
  std::vector<double> all;
  std::vector<std::uint8_t> truth;
  for (const Configuration& q : tested) {
    all.insert(all.end(), q.begin(), q.end());
    truth.push_back(checked.front().explain(q).empty() ? 1 : 0);
  }
  for (std::size_t i = 0; i < checked.size(); ++i) {
    ASSERT_EQ(checked[i].free(all, tested.size()), truth) << "batch, instruction set " << i;
    for (std::size_t k = 0; k < tested.size(); ++k) {
      ASSERT_EQ(checked[i].free(tested[k]), truth[k] != 0) << "one, instruction set " << i;
    }
  }
}

TEST(RobotLanes, VerdictsAreThoseOfTheCanonicalTestsToTheLastDigit) {
  Random random(seeded(911));
  int close = 0;
  for (int n = 0; n < scaled(230, 25); ++n) {
    const auto [scene, oracle] = scene_with_solids(random);
    Checked checked(scene);
    const auto is_free = [&](const Configuration& q) { return checked.explain(q).empty(); };
    std::vector<Configuration> tested;
    for (int i = random.whole(1, 19); i > 0; --i) {
      tested.push_back(random_configuration(random, oracle.robot, 3.0));
    }
    const auto first_free = std::find_if(tested.begin(), tested.end(), is_free);
    const auto first_touching = std::find_if_not(tested.begin(), tested.end(), is_free);
    if (first_free != tested.end() && first_touching != tested.end()) {
      // A free and a touching one with nothing between them.
      Configuration free = *first_free;
      Configuration touching = *first_touching;
      for (int i = 0; i < 60; ++i) {
        const Configuration middle = on_the_way(free, touching, 0.5);
        (is_free(middle) ? free : touching) = middle;
      }
      tested.push_back(free);
      tested.push_back(touching);
      ++close;
    }
    expect_same_answers(scene, tested);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(close, effort(40, 3));
}

// Bodies that no obstacle is near move, too.
TEST(RobotLanes, PairsWithoutObstaclesAreNotPassed) {
  RobotModel robot("base");
  robot.add_link("mid", "base", turning(-4, 4));
  robot.add_link("arm", "mid", turning(-4, 4));
  robot.attach("base", one_sphere_tree({0, 1, 0}, 0.01));
  robot.attach("mid", one_sphere_tree({0, 0, 5}, 0.01));
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.01));
  for (Checked& checked : checked_of(RobotScene(robot))) {
    EXPECT_EQ(checked.edge({0.02, 0.0}, {3.0, 0.0}).verdict, Verdict::kCollision);
  }
}

// An obstacle as far away as the robot reaches, to the last digits of single precision, does not
// change which tests single precision leaves to double precision.
TEST(RobotLanes, WhatIsJustOutOfReachHidesNothing) {
  const RobotModel robot = one_arm(turning(-4, 4), {1, 0, 0}, 0.1);
  for (int i = -40; i <= 40; ++i) {
    RobotScene scene(robot);
    scene.add("a", Primitive(Box{{1, 1, 1}}),
              Pose::from_translation({2.7 * (1.0 + i * 2e-7), 0, 0}));
    scene.add("b", Primitive(SolidSphere{0.1}), Pose::from_translation({0, 1.2 - 1e-6, 0}));
    const double middle = 1.5707963267948966;
    EXPECT_NE(Checked(scene).edge({middle - 0.7}, {middle + 1.1}).verdict, Verdict::kFree);
  }
}

TEST(RobotLanes, ANeedleOfACylinderIsNoContact) {
  RobotModel robot = one_arm(turning(-4, 4), {0, 0, 10}, 0.1);
  robot.attach("arm", one_sphere_tree({0, 0, -10}, 0.1));
  RobotScene scene(robot);
  scene.add("needle", Primitive(Cylinder{1e-50, 1.0}));
  expect_same_answers(scene, {{0.0}, {0.5}, {1.0}});
}

// Rigid pairs that rounding decides have the answers of each configuration.
TEST(RobotLanes, RigidPairsAtRoundingsDistance) {
  RobotModel robot = one_arm(turning(-4, 4), {0.5, 0, 0}, 0.1);
  robot.add_link("tip", "arm", {.type = JointType::kFixed});
  robot.attach("tip", one_sphere_tree({0.7 + 3.5e-15, 0, 0}, 0.1));
  RobotScene scene(robot);
  AllowedCollisions allowed(robot);
  allowed.forbid("arm", "tip");
  scene.set_allowed_collisions(allowed);
  Random random(seeded(913));
  std::vector<Configuration> tested;
  for (int i = 0; i < 50; ++i) tested.push_back({random.between(-3.0, 3.0)});
  expect_same_answers(scene, tested);
  EXPECT_NE(Checked(scene).edge(tested[0], tested[1]).verdict, Verdict::kFree);
}

// A body that touches no triangle and is wholly inside, all along its motion.
TEST(RobotLanes, AMotionInsideAMeshIsNotFree) {
  RobotScene scene(one_arm(sliding(-9, 9), {0, 0, 0}, 1e-3));
  for (const int kind : {0, 1, 6}) {
    TriangleMesh mesh = mesh_of_kind(kind);
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= 3.0;
    scene.add("solid", std::make_shared<const SolidMesh>(mesh));
    for (Checked& checked : checked_of(scene)) {
      for (double at = -1.4; at < 1.4; at += 0.07) {
        EXPECT_FALSE(checked.free(Configuration{at})) << kind << " at " << at;
        EXPECT_NE(checked.edge({at}, {at + 0.01}).verdict, Verdict::kFree);
      }
    }
    scene.remove("solid");
  }
}

// A body on a line through the middle of a sphere of fine triangles, far smaller than the growth.
TEST(RobotLanes, AMeshTouchesWithinItsGrowth) {
  RobotScene scene(one_arm(sliding(-9, 9), {0, 0, 0}, 1e-3));
  TriangleMesh mesh = icosphere(4);
  mesh.vertex_error = 0.5;
  scene.add("solid", std::make_shared<const SolidMesh>(mesh));
  for (const double offset : {0.0, 7.0}) {
    scene.move("solid", Pose::from_translation({offset, 0, 0}));
    for (Checked& checked : checked_of(scene)) {
      for (const double at : {1.2, 1.3, 1.4, 1.45}) {
        EXPECT_FALSE(checked.free(Configuration{offset - at})) << at;
        EXPECT_NE(checked.edge({offset - at}, {offset - at - 0.01}).verdict, Verdict::kFree) << at;
        EXPECT_EQ(checked.free(std::vector<double>(16, offset - at), 16),
                  std::vector<std::uint8_t>(16, 0))
            << at;
      }
      EXPECT_TRUE(checked.free(Configuration{offset - 1.6}));
    }
  }
}

}  // namespace
}  // namespace spherule::test::robot_lanes_test
