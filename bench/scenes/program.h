// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/work_cell_parts.h"
#include "geometry/pose.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule {

// Joint positions are multiples of 2^-20 radians (one micrometre at a metre's reach): rounding
// hides what the library's sine and cosine do in their last bits, so that every machine gets the
// same.
ArmPositions on_joint_grid(const ArmPositions& positions);

inline constexpr std::size_t kProgramSize = 15178;  // collision checks of the paper's experiment

// Where table and workpiece stand in the robot's base frame.
Pose world_from_table();
Pose world_from_workpiece();

struct Program {
  std::vector<ArmPositions> configurations;
  // 1 for those in which the wire is at the metal, on a pass: the paper's critical section.
  std::vector<std::uint8_t> is_critical;
};

// The weld program of the work cell, in the order in which the robot runs it: from home over the
// workpiece, down to a seam, along it a few millimetres off with weave and tilt, up and home again,
// for passes over the joint's seams, along the pipes and around their rims. In places the wire is
// pushed on to the metal (tack points); between some passes the torch is taken to a station behind
// the fixture post by a move that does not mind the post, so that forearm and wrist hit it.
// Continuous, within the joint limits, the same numbers on every machine (see on_joint_grid()).
// Throws Error if a target is out of reach.
Program make_program(const Pose& flange_from_wire);

// The same configurations in an order without coherence (seeded, the same on every machine).
std::vector<ArmPositions> shuffled(std::vector<ArmPositions> program, std::uint64_t seed);

}  // namespace spherule
