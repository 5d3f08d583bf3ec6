// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The check kernels, compiled once for each instruction set: the including file defines
// SPHERULE_KERNEL, a namespace of its own. Vectors are those of the compiler, which makes of them
// what the machine has. Nothing here comes from a header with inline functions, which the linker
// could share between files that were compiled for different machines.
//
// Which instructions and which order of operations are used changes the rounding, and so what is
// found apart, but not the answer: a pair that is not surely apart or surely in contact is
// confirmed elsewhere.

// Every function with vectors is inlined: none crosses a boundary between files.
#pragma GCC diagnostic ignored "-Wpsabi"

#include "collide/mechanism/kernel_block.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

void place(const KernelProblem& problem, const double* configuration,
           const KernelScratch& scratch) {
  place_frames(problem, configuration, scratch);
  place_roots(problem, scratch);
}

SPHERULE_INLINE bool are_apart(const KernelTask& root, const KernelObstacle& obstacle) {
  const float dx = obstacle.center[0] - root.x;
  const float dy = obstacle.center[1] - root.y;
  const float dz = obstacle.center[2] - root.z;
  const float limit = obstacle.radius + root.radius;
  return dx * dx + dy * dy + dz * dz > limit * limit;
}

bool check(const KernelProblem& problem, const double* configuration, const KernelScratch& scratch,
           ConfirmContact confirm, void* context) {
  place(problem, configuration, scratch);
  for (std::int32_t i = 0; i < problem.pair_count; ++i) {
    const KernelPair pair = problem.pairs[i];
    const KernelTask& root = scratch.roots[pair.body];
    const KernelBody& body = problem.bodies[pair.body];
    const KernelObstacle& obstacle = problem.obstacles[pair.obstacle];
    if (are_apart(root, obstacle)) continue;
    Contact contact(pair, 0, body.margin + obstacle.margin, confirm, context);
    const Placement at = in_single_precision(scratch.poses[body.frame]);
    if (PairSearch<Contact>(body, obstacle, at, scratch.tasks, contact).run(root)) return true;
  }
  return false;
}

KernelBlockAnswer check_block(const KernelProblem& problem, const double* const* configurations,
                              const KernelScratch& scratch, ConfirmContact confirm, void* context) {
  const unsigned refused = gather(problem, configurations, scratch.lane_variables);
  place_lane_frames(problem, scratch.lane_variables, scratch.lane_poses);
  unsigned hits = 0;
  Vectors roots;
  std::int32_t placed_body = -1;
  for (std::int32_t i = 0; i < problem.pair_count; ++i) {
    const KernelPair pair = problem.pairs[i];
    const KernelBody& body = problem.bodies[pair.body];
    const KernelObstacle& obstacle = problem.obstacles[pair.obstacle];
    if (pair.body != placed_body) {
      roots = image(scratch.lane_poses[body.frame], body.lane_center);
      placed_body = pair.body;
    }
    const Floats dx = roots.x - obstacle.center[0];
    const Floats dy = roots.y - obstacle.center[1];
    const Floats dz = roots.z - obstacle.center[2];
    const float limit = obstacle.radius + (body.radius + body.lane_error);
    const unsigned near =
        at_most(dx * dx + dy * dy + dz * dz, limit * limit) & kAllLanes & ~(hits | refused);
    if (near == 0) continue;
    hits |= BlockPair(problem, i, roots, scratch, confirm, context).run(near);
  }
  return {hits, refused};
}

// Ends a search for a grown body at the first leaves.
class InflatedContact {
 public:
  InflatedContact(const Contact& contact, float inflation)
      : contact_(contact), inflation_(inflation) {}

  SPHERULE_INLINE bool operator()(std::int32_t body_sphere, std::int32_t obstacle_sphere,
                                  float squared_distance, float limit) {
    const float as_they_are = (limit - inflation_) - limit * kRounding;
    touch_ = as_they_are > 0.0F && squared_distance <= as_they_are * as_they_are &&
             contact_(body_sphere, obstacle_sphere, squared_distance, as_they_are);
    return true;
  }

  bool touch() const { return touch_; }

 private:
  // Far above what two sums and a difference of numbers below the limit err by.
  static constexpr float kRounding = 0x1p-20F;

  Contact contact_;
  float inflation_;
  bool touch_ = false;
};

KernelFinding test(const KernelProblem& problem, KernelPair pair, float inflation,
                   const KernelScratch& scratch, ConfirmContact confirm, void* context) {
  const KernelBody& body = problem.bodies[pair.body];
  const KernelObstacle& obstacle = problem.obstacles[pair.obstacle];
  KernelTask root = scratch.roots[pair.body];
  root.radius += inflation;
  if (are_apart(root, obstacle)) return KernelFinding::kApart;
  Placement at = in_single_precision(scratch.poses[body.frame]);
  at.inflation = inflation;
  InflatedContact leaves(Contact(pair, 0, body.margin + obstacle.margin, confirm, context),
                         inflation);
  if (!PairSearch<InflatedContact>(body, obstacle, at, scratch.tasks, leaves).run(root)) {
    return KernelFinding::kApart;
  }
  return leaves.touch() ? KernelFinding::kTouch : KernelFinding::kNear;
}

constexpr Kernels kKernels = {&check, &check_block, &place, &test};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
