// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What checks of mechanisms are made from: whether it can be, and as the kernels have it.

#include "collide/mechanism/mechanism_kernel.h"
#include "collide/mechanism_check.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule::internal {

// Each throws Error, where an index is out of range, something is missing or a number cannot be
// used.
void check_frames(std::span<const MechanismFrame> frames);
void check_body(std::size_t body, int frame, std::size_t frame_count, bool has_shape);
void check_obstacles(std::span<const MechanismObstacle> obstacles);
void check_pairs(std::span<const MechanismPair> pairs, std::size_t bodies, std::size_t obstacles);
void check_pose_error(double pose_error);

KernelFrame kernel_frame(const MechanismFrame& frame);

// How many variables the frames name: one more than the largest index.
int variable_count(std::span<const MechanismFrame> frames);

// From the root to a frame: the largest distance of its origin, and how many frames it takes.
struct Chain {
  double length = 0.0;
  double frames = 0.0;
};

// Of every frame; throws Error for one of more than kLongestLaneChain frames.
std::vector<Chain> chains_of(std::span<const MechanismFrame> frames);

// Throws Error for instructions that this machine has not got.
const Kernels& kernels_for(InstructionSet instructions);

}  // namespace spherule::internal
