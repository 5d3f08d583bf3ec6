// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A compiled check of a jointed mechanism as plain data, and the kernels that evaluate it in lanes:
// eight configurations, or the middles of eight parts of a motion, side by side. `Real` is float
// for the fast evaluation and double for what that leaves undecided. All lengths are in the frame
// of the mechanism's root. Bounds and error budgets: plan_search.h, compiled_plan.cpp.

#include "collide/search/packed_tree.h"

#include <cstdint>

namespace spherule::internal {

// Configurations that are evaluated side by side.
inline constexpr int kPlanLanes = 8;

// A number for each lane.
template <class Real>
struct alignas(sizeof(Real) * kPlanLanes) PlanNumbers {
  Real lane[kPlanLanes];
};

// A frame that a position moves: `rotation` and `origin` lead from the parent to it at position
// zero, then it turns about its z axis by the position (or is shifted along it). Frame 0 is the
// root, which nothing moves.
template <class Real>
struct PlanFrame {
  Real rotation[3][3];  // columns
  Real origin[3];
  std::int32_t parent;  // an earlier frame
  std::int32_t position;
  bool prismatic;
};

// A node of a sphere tree in depth-first order: its descendants follow it, up to `next`. The sphere
// is inflated by its share of the error budget.
template <class Real>
struct PlanNode {
  Real center[3];
  Real radius;
  std::int32_t next;
  std::int32_t sphere;  // -1: an inner node
};

// Obstacles against which a body is tested, eight at a time: their bounding boxes, rounded outward.
// Where there are fewer than eight the rest is empty.
template <class Real>
struct alignas(64) PlanBoxes {
  Real lower[3][kPlanLanes];
  Real upper[3][kPlanLanes];
  std::int32_t obstacle[kPlanLanes];
  std::int32_t body;
};

// Spheres that move with a frame.
template <class Real>
struct PlanBody {
  const PlanNode<Real>* nodes;
  std::int32_t node_count;
  std::int32_t frame;
  std::int32_t first_center;  // of its nodes, among the placed centres
  std::int32_t first_group;   // of its obstacles
  std::int32_t group_count;
  Real error;   // of placed centres
  Real margin;  // leaves that overlap by this and the other side's margin are certain to touch
  bool is_confirmed;  // no contact is certain: the margin is infinite
};

enum class PlanShape : std::int32_t { kBox, kSegment, kCylinder, kHalfSpace, kTree };

// A static obstacle. Coordinates of a point p in its frame are `rotation` (rows) times p - center.
template <class Real>
struct PlanObstacle {
  PlanShape shape;
  Real rotation[3][3];
  Real center[3];
  Real half[3];  // of a box; {radius, -, half length} of a cylinder; {-, -, half length} of a
                 // segment
  Real radius;   // of a sphere or capsule, about its segment; with the inflation
  Real error;    // of the offset of a point from the solid
  Real margin;
  bool is_confirmed;            // as that of a body
  const PlanNode<Real>* nodes;  // of a tree
};

// Two bodies that are tested against each other.
struct PlanPair {
  std::int32_t first;
  std::int32_t second;
  bool second_moves;         // against the root by joints that do not move the first as well
  bool is_proved_somewhere;  // as PlanSource::Test has it
};

// Where a pair is proved apart, by the positions of at most two joints (FreeCells): bit i of word j
// for the coordinates i and j, (position - lower) * scale, rounded down.
struct PlanFreeCells {
  static constexpr int kCells = 64;
  const std::uint64_t* words;  // null: nowhere
  std::int32_t position[2];
  double lower[2];
  double scale[2];
};

// The k-th joint on eight paths, each from one body to another (or to the root): how far points of
// the first, and of the second body, are at most from its axis. Behind the last joint zeros, and a
// position behind all, which never changes.
template <class Real>
struct alignas(64) PlanPathStep {
  Real first[kPlanLanes];
  Real second[kPlanLanes];
  Real turns[kPlanLanes];   // 1 if it turns, otherwise 0
  Real slides[kPlanLanes];  // 1 if it is prismatic, otherwise 0
  std::int32_t position[kPlanLanes];
};

// Eight paths.
struct PlanPathGroup {
  std::int32_t first_step;
  std::int32_t step_count;
};

// Tests are numbered: those of bodies and obstacles first (eight times the group, and the lane in
// it), then the pairs.
template <class Real>
struct CheckPlan {
  const PlanFrame<Real>* frames;
  std::int32_t frame_count;
  std::int32_t position_count;
  const PlanBody<Real>* bodies;
  std::int32_t body_count;
  const PlanBoxes<Real>* groups;
  const PlanObstacle<Real>* obstacles;
  const PlanPair* pairs;
  const PlanFreeCells* free_cells;  // of each pair
  std::int32_t pair_count;
  std::int32_t first_never;  // of the pairs behind which all are PlanSource::Test::never_touches
  std::int32_t bound_count;  // one for the bodies, and for every eight pairs
  const PlanPathGroup* body_paths;
  const PlanPathGroup* pair_paths;
  const PlanPathStep<Real>* steps;
  bool slides;              // whether any joint is prismatic
  Real bound_slack;         // factor by which sums of bounds are inflated for rounding
  Real velocity_error;      // of velocities, for each unit of the sum of all rates
  std::int32_t first_pair;  // the number of the first test of two bodies
  std::int32_t test_count;
  std::int32_t word_count;  // of a set of tests, one bit each
};

template <class Real>
struct alignas(64) PlanPose {
  Real columns[4][3][kPlanLanes];  // three of the rotation, and the origin
};

// A velocity of a frame: that of a point p is at_origin + turning x p.
template <class Real>
struct alignas(64) PlanTwist {
  Real turning[3][kPlanLanes];
  Real at_origin[3][kPlanLanes];
};

template <class Real>
struct alignas(64) PlanCenter {
  Real at[3][kPlanLanes];
};

// How far a body moves, or one body against another, per unit of the motion's time.
template <class Real>
struct PlanMotionBound {
  Real speed;  // of any point
  Real bend;   // half of the acceleration of any point
};

// A test of which some lanes are not found apart by the spheres around all.
struct PlanCandidate {
  std::int32_t test;
  std::int32_t body;
  unsigned near;
  unsigned overlap;  // as placed, without the motion
};

// Two nodes, in lanes, that wait in a search.
struct PlanTask {
  std::int32_t a;
  std::int32_t b;
  unsigned lanes;
};

// Tests in which there was a contact in an earlier evaluation, the last one first: likely to touch
// again.
struct PlanRecent {
  static constexpr std::int32_t kMost = 8;
  std::int32_t tests[kMost];
  std::int32_t count = 0;
};

// Memory of one caller, enough of it for the plan.
struct WidePlan;
struct WideScratch;

template <class Real>
struct PlanScratch {
  PlanNumbers<double>* positions;  // of each joint, in every lane; in, for configurations
  PlanPose<Real>* poses;
  PlanTwist<Real>* twists;
  PlanCenter<Real>* centers;  // of all nodes of all bodies
  std::uint64_t* placed;      // of each: the evaluation that has placed it
  std::uint64_t* evaluation;  // the number of the last
  PlanCandidate* candidates;
  PlanTask* tasks;
  // Of a motion.
  double* from;  // in: positions at both ends
  double* to;
  Real* rates;   // in: by how much each position changes, signed
  Real* speeds;  // in: its magnitude, rounded up; one more, which is zero
  Real* shifts;  // in: the largest magnitude of the position, rounded up; one more, zero
  PlanMotionBound<Real>* body_bounds;
  PlanMotionBound<Real>* pair_bounds;
  PlanNumbers<Real>* path_work;  // twice the longest path and four
  Real* total_speed;             // in: the sum of all speeds
  PlanRecent* recent;
  bool* has_bounds;  // in: all false for a new motion; of bodies, then of groups of eight pairs
  // The same plan for one configuration, if there is one: what only a few lanes have to search.
  const WidePlan* wide;
  const WideScratch* wide_scratch;
};

// What the caller decides.
struct PlanClient {
  // Whether the test's sides touch in the lane's configuration, by the canonical test.
  bool (*touches)(void* context, int lane, std::int32_t test);
  // Of two sides whose contacts are confirmed, no point of which is faster than `speed` against the
  // other one: those of the lanes in whose parts the two are not proved apart.
  unsigned (*near)(void* context, std::int32_t test, unsigned lanes, double speed);
  // Of two bodies that are proved free somewhere: whether they are in the lane's configuration; all
  // along the motion; and in which lanes they are all along the part.
  bool (*is_proved_free)(void* context, int lane, std::int32_t test);
  bool (*is_motion_proved)(void* context, std::int32_t test);
  unsigned (*proved_parts)(void* context, std::int32_t test, unsigned lanes);
  void* context;
  bool skips_never;  // those pairs need no test in any of the lanes
};

// Parts of a motion, one in each lane, evaluated at their middles.
struct PlanParts {
  alignas(64) double middle[kPlanLanes];  // in: of each, a fraction of the motion
  alignas(64) double half[kPlanLanes];    // in: half the length of each
  unsigned lanes = 0;                     // in: those that count
  const std::uint64_t* open = nullptr;    // in: a set of tests for each lane; null: all tests
  double enough = 0.0;        // in: what is inflated by no more than this is not split any more
  std::uint64_t* near;        // out: a set for each lane: tests that are not proved apart
  unsigned any_near = 0;      // out: lanes whose set is not empty
  unsigned given_up = 0;      // out: lanes with a test that was not inflated by more than `enough`
  unsigned contacts = 0;      // out: lanes in whose middles there is a contact
  bool all_contacts = false;  // in: go on after a contact; otherwise `near` is not complete then
};

// Of the motion given by rates, speeds and shifts.
template <class Real>
using EvaluateParts = void (*)(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch,
                               PlanParts& parts, const PlanClient& client);

struct PlanKernelSet {
  EvaluateParts<float> evaluate_float;
  EvaluateParts<double> evaluate_double;
  // Lanes in whose configurations some test touches.
  unsigned (*check_lanes)(const CheckPlan<float>& plan, const PlanScratch<float>& scratch,
                          unsigned lanes, const PlanClient& client);
  // Whether any test touches in one configuration.
  bool (*check_one)(const CheckPlan<float>& plan, const WidePlan& wide, const WideScratch& scratch,
                    const PlanClient& client);
};

const PlanKernelSet& portable_plan_kernels();
#if defined(SPHERULE_X86_KERNELS)
const PlanKernelSet& avx2_plan_kernels();
const PlanKernelSet& avx512_plan_kernels();
#endif

}  // namespace spherule::internal

// What a CheckPlan is for one configuration: the lanes are obstacles, bodies, or eight children of
// a node, in place of eight configurations. Plain data.

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
