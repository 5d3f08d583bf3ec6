// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a check of a mechanism against standing obstacles works on, as plain data, and the kernels
// that do it, one for each instruction set. All lengths are in the frame of the mechanism's root.

#include "collide/internal/packed_node.h"

#include <cstdint>

namespace spherule::internal {

// A frame that a variable moves: `rotation` and `origin` lead from the parent to it at zero, then
// it turns about its z axis (or is shifted along it) by the variable.
struct alignas(32) KernelFrame {
  double rotation[3][4];  // columns; the fourth number is zero
  double origin[3];
  std::int32_t parent;  // an earlier frame, or -1 for the root
  std::int32_t variable;
  bool prismatic;
};

struct KernelBody {
  const PackedNode* nodes;
  double center[3];  // of the ball around all, in the frame
  float radius;
  std::int32_t frame;
  float margin;  // of a leaf's radius, no more is for sure
};

struct KernelObstacle {
  const PackedNode* nodes;
  float center[3];
  float radius;
  float margin;
};

struct KernelPair {
  std::int32_t body;
  std::int32_t obstacle;
};

// A ball of one side, in the root's frame, and where the search goes on: a node of the other side
// is opened, or, where that side has come to a leaf (negative, ~sphere), the ball is the leaf's and
// this side's node is opened.
struct KernelTask {
  float x, y, z, radius;
  std::int32_t body;
  std::int32_t obstacle;
};

// Of a frame: three columns and the origin.
struct alignas(32) KernelPose {
  double columns[4][4];
};

struct KernelProblem {
  const KernelFrame* frames;
  std::int32_t frame_count;
  std::int32_t variable_count;
  const KernelBody* bodies;
  std::int32_t body_count;
  const KernelObstacle* obstacles;
  const KernelPair* pairs;  // in the order in which they are tested
  std::int32_t pair_count;
};

// Memory of the caller, enough of it: sines and cosines for the variables, filled up to a multiple
// of four, a pose for every frame, a ball for every body, and as many tasks as can wait.
struct KernelScratch {
  double* sines;
  double* cosines;
  KernelPose* poses;
  KernelTask* roots;
  KernelTask* tasks;
};

// Spheres that single precision cannot tell apart: whether they touch.
using ConfirmContact = bool (*)(void* context, KernelPair pair, std::int32_t body_sphere,
                                std::int32_t obstacle_sphere);

// True if a pair of spheres touches for sure or is confirmed to; false if none can. `configuration`
// is filled up with finite numbers to a multiple of four.
using CheckKernel = bool (*)(const KernelProblem& problem, const double* configuration,
                             const KernelScratch& scratch, ConfirmContact confirm, void* context);

CheckKernel portable_check_kernel();
#if defined(SPHERULE_AVX2_KERNEL)
CheckKernel avx2_check_kernel();
#endif

// Of a sine and its cosine together, see mechanism_kernel_impl.h.
inline constexpr double kSineError = 2e-11;

}  // namespace spherule::internal
