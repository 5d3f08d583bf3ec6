// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/fcl_sphere_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/oracle.h"
#include "bench/tests/surface_spheres.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

std::vector<ArmPositions> every(const Workload& cell, std::size_t stride) {
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += stride) sample.push_back(cell.program[i]);
  return sample;
}

std::vector<std::uint8_t> verdicts(Checker& checker, const std::vector<ArmPositions>& sample) {
  std::vector<std::uint8_t> result(sample.size(), 2);
  checker.check(sample, result);
  return result;
}

TEST(Engines, FclAgreesWithTheOracleInEverySetting) {
  const Workload cell = make_paper_cell();
  const auto sample = every(cell, 23);
  const auto touching = Oracle(cell).touching_bodies(sample);
  std::size_t collisions = 0;
  for (const std::uint32_t bits : touching) collisions += bits != 0 ? 1 : 0;
  ASSERT_GT(collisions, 50u);
  for (const FclMeshSetting& setting : all_fcl_mesh_settings()) {
    const auto found = verdicts(*make_fcl_mesh_checker(cell, setting), sample);
    for (std::size_t i = 0; i < sample.size(); ++i) {
      EXPECT_EQ(found[i] != 0, touching[i] != 0) << to_string(setting) << " " << i;
    }
  }
}

TEST(Engines, SphereEnginesAgreeAndMissNothing) {
  Workload cell = make_paper_cell();
  test::add_surface_spheres(cell);
  const auto sample = every(cell, 601);
  const auto touching = Oracle(cell).touching_bodies(sample);
  const auto by_tree = verdicts(*make_tree_checker(cell, TreeMode::kSingle), sample);
  EXPECT_EQ(by_tree, verdicts(*make_tree_checker(cell, TreeMode::kPairs), sample));
  EXPECT_EQ(by_tree, verdicts(*make_fcl_sphere_checker(cell), sample));
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (touching[i] != 0) {
      EXPECT_EQ(by_tree[i], 1) << i;
    }
  }
}

// A small cube on the robot's last link inside of a large hollow shell's solid: no two triangles
// meet, so FCL alone says free.
TEST(Oracle, SeesABodyInsideAnother) {
  Workload cell{.name = "inside", .robot = make_robot()};
  cell.bodies.push_back({{.name = "cube", .mesh = make_cube(0.05)}, kJoints});
  cell.obstacles.push_back({{.name = "block", .mesh = make_cube(8.0)}, Pose()});
  const std::vector<ArmPositions> sample{ArmPositions{}};
  EXPECT_EQ(verdicts(*make_fcl_mesh_checker(cell, {}), sample)[0], 0);
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 1u);
  std::swap(cell.bodies[0].part.mesh, cell.obstacles[0].part.mesh);
  cell.obstacles[0].world_from_part = Pose::from_translation({1.5, 0.0, 1.5});
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 1u);
  cell.obstacles[0].world_from_part = Pose::from_translation({0.0, 0.0, 9.0});
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 0u);
}

// What the base is bolted beside is not queried.
TEST(Workload, LeavesOutTheBaseAgainstTheTable) {
  const Workload cell = make_paper_cell();
  std::size_t left_out = 0;
  for (const Body& body : cell.bodies) {
    for (const Obstacle& obstacle : cell.obstacles) {
      if (is_tested(body, obstacle)) continue;
      ++left_out;
      EXPECT_EQ(body.part.name, "base_link");
      EXPECT_EQ(obstacle.part.name, "table");
    }
  }
  EXPECT_EQ(left_out, 1u);
}

}  // namespace
}  // namespace spherule
