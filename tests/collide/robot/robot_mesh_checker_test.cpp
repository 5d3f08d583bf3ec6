// SPDX-License-Identifier: BSD-3-Clause
// Robots that stay meshes among spheres: the answers of collides() for every pair.

#include "collide/robot/robot_mesh_checker.h"

#include "collide/robot/kinematics.h"
#include "spheretree/build.h"
#include "spheretree/error.h"
#include "tests/collide/robot/robots.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

std::shared_ptr<const MeshTree> random_mesh(SceneRandom& random, double size) {
  TriangleMesh mesh;
  const int count = random.whole(1, 40);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a = random.point(size);
    mesh.vertices.insert(mesh.vertices.end(),
                         {a, a + random.point(0.3 * size), a + random.point(0.3 * size)});
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return std::make_shared<const MeshTree>(mesh);
}

std::vector<PlacedTree> random_obstacles(SceneRandom& random) {
  std::vector<PlacedTree> obstacles;
  for (int k = random.whole(1, 3); k > 0; --k) {
    obstacles.push_back({std::make_shared<const SphereTree>(
                             build_tree(random_spheres(random, random.whole(1, 40), 0.6, 0.2))),
                         random.pose(1.5)});
  }
  return obstacles;
}

TEST(RobotMeshChecker, AnswersAsThePairsDoOnEveryInstructionSet) {
  SceneRandom random(71);
  int hits = 0;
  int free = 0;
  for (int i = 0; i < 60; ++i) {
    const RobotModel robot = random_robot(random, random.whole(1, 6), i % 2 == 1);
    std::vector<LinkMesh> meshes;
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      if (random.whole(0, 3) == 0) continue;
      meshes.push_back({static_cast<int>(link), random_mesh(random, 0.4)});
    }
    std::vector<PlacedTree> obstacles = random_obstacles(random);
    RobotMeshCheckerOptions options{.world_from_root = random.pose(1.0)};
    if (i % 3 == 0) {
      options.untested.push_back({0, 0});
      options.untested.push_back({static_cast<int>(robot.links().size()) - 1, 0});
    }
    std::vector<RobotMeshChecker> checkers;
    for (const InstructionSet set : instruction_sets()) {
      options.instructions = set;
      checkers.emplace_back(robot, meshes, obstacles, options);
    }
    std::vector<Pose> placed;
    for (int k = 0; k < 20; ++k) {
      // The last ones are far out of the kernels' range.
      const std::vector<double> q = random_configuration(random, robot, k < 18 ? 2.0 : 300.0);
      forward_kinematics(robot, q, placed, options.world_from_root);
      bool expected = false;
      for (const LinkMesh& mesh : meshes) {
        for (std::size_t o = 0; o < obstacles.size(); ++o) {
          const bool is_tested =
              std::none_of(options.untested.begin(), options.untested.end(),
                           [&](const auto& p) { return p.link == mesh.link && p.obstacle == o; });
          expected = expected ||
                     (is_tested && collide(*obstacles[o].tree, obstacles[o].world_from_tree,
                                           *mesh.mesh, placed[static_cast<std::size_t>(mesh.link)])
                                           .verdict == Verdict::kCollision);
        }
      }
      for (const RobotMeshChecker& checker : checkers) {
        RobotMeshChecker::Scratch scratch(checker);
        ASSERT_EQ(checker.collides(q, scratch), expected) << i << ' ' << k;
      }
      (expected ? hits : free) += 1;
    }
  }
  EXPECT_GT(hits, 150);
  EXPECT_GT(free, 150);
}

TEST(RobotMeshChecker, RefusesWhatItCannotUse) {
  SceneRandom random(72);
  const RobotModel robot = random_robot(random, 2, false);
  const auto mesh = random_mesh(random, 0.2);
  const std::vector<PlacedTree> obstacles = random_obstacles(random);
  EXPECT_THROW(RobotMeshChecker(robot, {{0, nullptr}}, obstacles), Error);
  EXPECT_THROW(RobotMeshChecker(robot, {{3, mesh}}, obstacles), Error);
  EXPECT_THROW(RobotMeshChecker(robot, {{-1, mesh}}, obstacles), Error);
  EXPECT_THROW(RobotMeshChecker(robot, {{1, mesh}}, {{nullptr, Pose()}}), Error);
  EXPECT_THROW(RobotMeshChecker(robot, {{1, mesh}}, obstacles, {.untested = {{0, 9}}}), Error);
  const RobotMeshChecker checker(robot, {{1, mesh}}, obstacles);
  RobotMeshChecker::Scratch scratch(checker);
  std::vector<double> q(static_cast<std::size_t>(robot.variable_count()), 0.0);
  EXPECT_NO_THROW(checker.collides(q, scratch));
  q.push_back(0.0);
  EXPECT_THROW(checker.collides(q, scratch), Error);
  q.pop_back();
  if (!q.empty()) {
    q[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(checker.collides(q, scratch), Error);
  }
}

// Also one in the place of that which the scratch was made for.
TEST(RobotMeshChecker, RefusesTheScratchOfAnother) {
  SceneRandom random(73);
  const RobotModel robot = random_robot(random, 2, false);
  const std::vector<LinkMesh> meshes = {{1, random_mesh(random, 0.2)}};
  const std::vector<PlacedTree> obstacles = random_obstacles(random);
  const std::vector<double> q(static_cast<std::size_t>(robot.variable_count()), 0.0);
  std::optional<RobotMeshChecker> checker(std::in_place, robot, meshes, obstacles);
  RobotMeshChecker::Scratch scratch(*checker);
  EXPECT_NO_THROW((void)checker->collides(q, scratch));
  for (int i = 0; i < 3; ++i) {
    checker.emplace(robot, meshes, obstacles);
    EXPECT_THROW((void)checker->collides(q, scratch), Error);
  }
  RobotMeshChecker::Scratch own(*checker);
  const RobotMeshChecker moved = *std::move(checker);
  EXPECT_NO_THROW((void)moved.collides(q, own));
}

}  // namespace
}  // namespace spherule::test
