// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a CheckPlan is for one configuration: the lanes are obstacles, bodies, or eight children of
// a node, in place of eight configurations. Plain data.

#include "collide/kernels/check_plan.h"
#include "collide/search/packed_node.h"

#include <cstdint>

namespace spherule::internal {

// A PlanFrame whose columns are vectors; the fourth number of each is zero.
struct alignas(16) WideFrame {
  float rotation[3][4];
  float origin[4];
  std::int32_t parent;
  std::int32_t position;
  bool prismatic;
};

struct WideBody {
  const PackedNode* nodes;
  float center[3];  // of the sphere around all, in the frame
  float radius;
  float margin;
  std::int32_t frame;
  std::int32_t first_node;  // among the placed nodes, unless the frame is the root
};

// A body and those of a group of bodies that it is tested against.
struct WidePartners {
  static constexpr int kGroup = 2 * kPlanLanes;
  std::int32_t body;
  std::int32_t group;
  std::int32_t first_test;  // the tests of the partners, in their order, among `pair_tests`
  std::uint16_t partners;
  std::uint16_t never;  // of these: those that never touch it (CheckPlan::first_never)
};

struct WidePlan {
  const WideFrame* frames;
  const WideBody* bodies;        // obstacles that are trees, in the root's frame, follow
  const std::int32_t* tree_of;   // of each obstacle: its place among `bodies`; -1 if it is no tree
  std::int32_t placed_count;     // of nodes that move
  const WidePartners* partners;  // those with a partner that may touch come first
  std::int32_t partners_count;
  std::int32_t touching_count;  // of these
  const std::int32_t* pair_tests;
};

// Three columns and the origin of a frame.
struct alignas(64) WidePose {
  float columns[4][4];
};

// The eight children of a node, placed.
struct alignas(32) WideSpheres {
  float at[3][kPlanLanes];
};

// A node of one body and a node of another; instead of one, below zero, a leaf by its slot (~slot).
// A slot is 8 times the node that holds a sphere and its lane.
struct WideTask {
  std::int32_t a;
  std::int32_t b;
  std::int32_t slot_of_b;  // of the sphere around all of node b; -1: that of the body
};

// Memory of one caller, enough of it for the plan: for one configuration, or for placed nodes of
// eight, one after the other.
struct WideScratch {
  double* positions;  // in; filled up to a multiple of eight
  float* sines;
  float* cosines;
  WidePose* poses;
  float* roots[3];  // centres of the spheres around all bodies, filled up to whole groups
  float* radii;
  WideSpheres* placed;
  std::uint64_t* stamps;  // of each: the evaluation that has placed it
  std::uint64_t* evaluation;
  WideTask* tasks;
  PlanRecent* recent;
};

}  // namespace spherule::internal
