// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/program.h"

#include "bench/oracle.h"
#include "bench/scenes/inverse_kinematics.h"
#include "bench/scenes/torch.h"
#include "bench/scenes/workpiece.h"
#include "robot/model/kinematics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace spherule {
namespace {

// FNV-1a over the grid steps.
std::uint64_t hash(const std::vector<ArmPositions>& program) {
  std::uint64_t value = 14695981039346656037U;
  for (const ArmPositions& positions : program) {
    for (const double q : positions) {
      auto steps = static_cast<std::uint64_t>(static_cast<std::int64_t>(q * 0x1p20));
      for (int byte = 0; byte < 8; ++byte, steps >>= 8)
        value = (value ^ (steps & 255U)) * 1099511628211U;
    }
  }
  return value;
}

TEST(Program, IsTheSameEverywhere) {
  const auto [program, is_critical] = make_program(flange_from_wire());
  ASSERT_EQ(program.size(), kProgramSize);
  ASSERT_EQ(is_critical.size(), kProgramSize);
  for (const ArmPositions& positions : program) EXPECT_EQ(on_joint_grid(positions), positions);
  EXPECT_EQ(hash(program), 0xc9a7e55f6321b085U);
}

TEST(Program, IsContinuousAndKeepsTheLimits) {
  const RobotModel robot = make_robot();
  const auto program = make_program(flange_from_wire()).configurations;
  for (std::size_t i = 0; i < program.size(); ++i) {
    for (std::size_t joint = 0; joint < program[i].size(); ++joint) {
      EXPECT_GE(program[i][joint], robot.joints()[joint].lower);
      EXPECT_LE(program[i][joint], robot.joints()[joint].upper);
      if (i > 0) {
        EXPECT_LT(std::abs(program[i][joint] - program[i - 1][joint]), 0.1) << i;
      }
    }
  }
}

// There the end of the wire is within the standoff, the weave and the room at a crotch of the
// metal.
TEST(Program, TheWireIsAtTheMetalInTheCriticalSection) {
  const RobotModel robot = make_robot();
  const auto [program, is_critical] = make_program(flange_from_wire());
  const Pose piece_from_world = world_from_workpiece().inverse();
  std::vector<Pose> world_from_link;
  std::size_t critical = 0;
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (is_critical[i] == 0) continue;
    ++critical;
    forward_kinematics(robot, program[i], world_from_link);
    const Eigen::Vector3d wire =
        piece_from_world *
        (world_from_link.back() * link6_from_flange() * flange_from_wire()).translation();
    double gap = 1.0;  // from the nearest pipe's outer surface
    for (int pipe = 0; pipe < 3; ++pipe) {
      const Eigen::Vector3d axis = pipe_axis(pipe);
      const double along = std::clamp(wire.dot(axis), 0.0, kPipeLength);
      gap = std::min(gap, (wire - along * axis).norm() - kPipeRadius);
    }
    EXPECT_LT(gap, 0.03) << i;
  }
  EXPECT_GT(critical, kProgramSize / 2);
  EXPECT_LT(critical, kProgramSize);
}

TEST(Program, ShufflingKeepsTheConfigurations) {
  const auto program = make_program(flange_from_wire()).configurations;
  auto mixed = shuffled(program, 7);
  EXPECT_NE(mixed, program);
  EXPECT_EQ(mixed, shuffled(program, 7));
  auto sorted = program;
  std::sort(sorted.begin(), sorted.end());
  std::sort(mixed.begin(), mixed.end());
  EXPECT_EQ(mixed, sorted);
}

TEST(InverseKinematics, BringsTheFlangeToTheTarget) {
  const RobotModel robot = make_robot();
  const ArmPositions reference{0.3, 0.2, 0.1, -0.4, 0.8, 0.5};
  std::vector<Pose> links;
  forward_kinematics(robot, reference, links);
  const Pose target = links.back() * link6_from_flange();
  const auto found = solve_inverse_kinematics(robot, target, {0.0, 0.0, 0.0, 0.0, 0.6, 0.0});
  ASSERT_TRUE(found.has_value());
  forward_kinematics(robot, *found, links);
  const Pose reached = links.back() * link6_from_flange();
  EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-5);
  EXPECT_LT((reached.matrix() - target.matrix()).norm(), 2e-5);
  EXPECT_FALSE(solve_inverse_kinematics(robot, Pose::from_translation({5.0, 0.0, 0.0}), reference));
}

// The oracle on a part of the program; the benchmark queries it about all of it.
TEST(Program, HasTheWantedShareOfCollisions) {
  const Workload cell = make_paper_cell();
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += 7) sample.push_back(cell.program[i]);
  std::size_t collisions = 0;
  std::vector<std::size_t> by_body(cell.bodies.size(), 0);
  for (const std::uint32_t bits : Oracle(cell).touching_bodies(sample)) {
    collisions += bits != 0 ? 1 : 0;
    for (std::size_t i = 0; i < by_body.size(); ++i) by_body[i] += bits >> i & 1U;
  }
  const double share = static_cast<double>(collisions) / static_cast<double>(sample.size());
  EXPECT_GT(share, 0.11);
  EXPECT_LT(share, 0.15);
  for (const char* name : {"torch", "link_4", "link_5"}) {
    const auto body = std::find_if(cell.bodies.begin(), cell.bodies.end(),
                                   [&](const Body& b) { return b.part.name == name; });
    ASSERT_NE(body, cell.bodies.end());
    EXPECT_GT(by_body[static_cast<std::size_t>(body - cell.bodies.begin())], 0u) << name;
  }
}

}  // namespace
}  // namespace spherule
