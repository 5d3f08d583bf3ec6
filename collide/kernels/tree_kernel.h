// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a check of a mechanism against standing obstacles works on, as plain data, and the kernels
// that do it, one for each instruction set. All lengths are in the frame of the mechanism's root.

#include "collide/search/packed_tree.h"

#include <cstdint>

namespace spherule::internal {

// A frame that a variable moves: `rotation` and `origin` lead from the parent to it at zero, then
// it turns about its z axis (or is shifted along it) by the variable.
struct alignas(32) KernelFrame {
  double rotation[3][4];  // columns; the fourth number of each is zero
  double origin[4];
  std::int32_t parent;  // an earlier frame, or -1 for the root
  std::int32_t variable;
  bool prismatic;
};

// The same for configurations side by side.
struct KernelLaneFrame {
  float rotation[3][3];  // columns
  float origin[3];
  std::int32_t parent;
  std::int32_t variable;
  bool prismatic;
};

struct KernelBody {
  const PackedNode* nodes;
  const PackedSphere* leaves;
  std::int32_t node_count;
  double center[3];  // of the sphere around all, in the frame
  float lane_center[3];
  float radius;
  std::int32_t frame;
  float margin;      // of a leaf's radius, no more is for sure
  float lane_error;  // how far the poses of lanes may be off
};

struct KernelObstacle {
  const PackedNode* nodes;
  const PackedSphere* leaves;
  float center[3];
  float radius;
  float margin;
};

struct KernelPair {
  std::int32_t body;
  std::int32_t obstacle;
};

// A sphere of one side, in the root's frame, and where the search goes on: a node of the other side
// is opened, or, where that side has come to a leaf (negative, ~sphere), the sphere is the leaf's
// and this side's node is opened.
struct KernelTask {
  float x, y, z, radius;
  std::int32_t body;
  std::int32_t obstacle;
};

// Two leaves, by their spheres.
struct KernelLeaves {
  std::int32_t body = -1;
  std::int32_t obstacle = -1;
};

// A body's place: columns and origin of its frame, and the centre of its sphere around all.
struct alignas(16) KernelReference {
  float columns[4][4];
  float center[3];
};

// What the last blocks have shown of a pair.
struct KernelMemory {
  KernelLeaves contact{};  // the last leaves that touched
  KernelReference pose{};  // there the body, grown by so much, is apart from the obstacle
  float inflation = 0.0F;
  float ambition = 0.5F;   // by how many times as much as needed to grow the body
  float widest = 0x1p-4F;  // up to this part of its radius it is grown for several configurations
};

// Of a frame: three columns and the origin.
struct alignas(32) KernelPose {
  double columns[4][4];
};

// Pairs of a sphere and a node that wait in a breadth-first search; there is room for eight more.
struct alignas(64) KernelQueue {
  static constexpr std::int32_t kRoom = 248;
  std::int32_t slots[kRoom + 8];
  std::int32_t nodes[kRoom + 8];
};

// Memory of a breadth-first search: for every node of the largest body and one more, its children
// where they are, and the search for which that was computed.
struct KernelQueues {
  KernelQueue* waiting;  // five
  KernelSpheres* placed;
  std::uint64_t* generations;
  std::uint64_t* generation;
};

// Configurations that are checked side by side.
inline constexpr int kLanes = 16;

struct alignas(64) KernelLaneVariable {
  double exact[kLanes];
  float rounded[kLanes];
  float remainder[kLanes];  // of an angle, beside a multiple of pi / 2
  std::int32_t quarter[kLanes];
};

struct alignas(64) KernelLanePose {
  float columns[4][3][kLanes];
};

struct KernelProblem {
  const KernelFrame* frames;
  const KernelLaneFrame* lane_frames;
  std::int32_t frame_count;
  std::int32_t variable_count;
  const KernelBody* bodies;
  std::int32_t body_count;
  const KernelObstacle* obstacles;
  const KernelPair* pairs;  // in the order in which they are tested
  std::int32_t pair_count;
};

// Memory of the caller, enough of it: sines and cosines for the variables, filled up to a multiple
// of four, a pose for every frame, a sphere for every body, and as many tasks as can wait. For
// lanes: their variables and poses, queues, and what is remembered of every pair.
struct KernelScratch {
  double* sines;
  double* cosines;
  KernelPose* poses;
  KernelTask* roots;
  KernelTask* tasks;
  KernelLaneVariable* lane_variables;
  KernelLanePose* lane_poses;
  KernelQueues queues;
  KernelMemory* memories;
};

// Spheres that single precision cannot tell apart: whether they touch in the configuration of a
// lane, or in the only one (0).
using ConfirmContact = bool (*)(void* context, std::int32_t lane, KernelPair pair,
                                std::int32_t body_sphere, std::int32_t obstacle_sphere);

// A bit for every configuration.
struct KernelBlockAnswer {
  unsigned hits;
  unsigned refused;  // a number is not finite or out of range
};

// Of a pair whose body is grown.
enum class KernelFinding { kApart, kNear, kTouch };

struct Kernels {
  // True if a pair of spheres touches for sure or is confirmed to; false if none can.
  bool (*check)(const KernelProblem& problem, const double* configuration,
                const KernelScratch& scratch, ConfirmContact confirm, void* context);
  // The same for kLanes configurations.
  KernelBlockAnswer (*check_block)(const KernelProblem& problem,
                                   const double* const* configurations,
                                   const KernelScratch& scratch, ConfirmContact confirm,
                                   void* context);
  // Puts the frames and the spheres around the bodies where a configuration has them.
  void (*place)(const KernelProblem& problem, const double* configuration,
                const KernelScratch& scratch);
  // What there is between the pair's sides with the body grown, as placed: nothing; two leaves
  // that touch as they are, ungrown, for sure or confirmed; or neither. Ends at the first two
  // leaves that are not apart.
  KernelFinding (*test)(const KernelProblem& problem, KernelPair pair, float inflation,
                        const KernelScratch& scratch, ConfirmContact confirm, void* context);
};

const Kernels& portable_kernels();
#if defined(SPHERULE_X86_KERNELS)
const Kernels& avx2_kernels();
const Kernels& avx512_kernels();
#endif

// The largest magnitude of a position, in radians or the unit of the trees, for which checks
// answer: all budgets of errors, those of motions too, are proved up to it. Beyond what joints of
// robots do (16 turns, 100 metres), and so small that a position less its whole turns is known to
// 2e-14 (vectors.h).
inline constexpr double kLargestPosition = 100.0;
// Of a sine and its cosine together, see vectors.h.
inline constexpr double kSineError = 2e-11;
// For each frame between root and body, of the largest distance from the root: how far a point may
// be off where poses are computed in lanes, see tree_poses.h.
inline constexpr double kLaneErrorPerFrame = 38.0 * 0x1p-24;
inline constexpr int kLongestLaneChain = 10000;

}  // namespace spherule::internal
