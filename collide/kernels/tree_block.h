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
//
// A block of up to sixteen configurations, one in each lane.
//
// Neighbours on a path differ little. One search for the configuration in the middle, with the
// body grown by how far it is from there in any other, finds the few pairs of leaves that may touch
// in any; these are tested in lanes. Where configurations are too far apart for that, their lanes
// are halved, until one is left and searched alone.
//
// By how much the body is grown. Let e be the error of the lanes' poses (`lane_error` of the body,
// tree_poses.h, which is above 14 v W), T the exact poses, c and rho the body's sphere around
// all. A point p of it is in lane i at most |T_i c - T_m c| + |R_i - R_m|_2 rho from where it is in
// lane m. The first is at most the computed distance of the centres + 3 e. The difference of two
// rotations has two equal singular values and a zero, so its norm is 1 / sqrt(2) of the one over
// its entries, which is computed with 2 e / W at most: 2 e / sqrt(2) more. One more e for the pose
// of lane m. Together: computed + 6 e; sums of squares, roots and products err by less than 2^-18.

#include "collide/kernels/tree_poses.h"
#include "collide/kernels/tree_search.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// For one search of several configurations a body is grown by at most KernelMemory::widest of its
// radius. A search that finds more than kManyFound pairs of leaves for each configuration, or has
// no room, lowers that to half of what it used; each time that it is not enough it rises by kWiden,
// up to kWidest.
constexpr float kWidest = 0.25F;
constexpr float kWiden = 1.0F + 0x1p-5F;
constexpr std::int32_t kManyFound = 8;
constexpr float kLooser = 1.0F + 0x1p-18F;
// A body is grown by this many times what is needed, twice as many after each search that found
// nothing; that is tried from kProbeFrom on, so not at once where something is near.
constexpr float kModest = 0.5F;
constexpr float kProbeFrom = 2.0F;
constexpr float kMostAmbition = 64.0F;

struct AnyLeaves {
  SPHERULE_INLINE bool operator()(std::int32_t, std::int32_t, float, float) const { return true; }
};

class BlockPair {
 public:
  BlockPair(const KernelProblem& problem, std::int32_t pair, const Vectors& roots,
            const KernelScratch& scratch, ConfirmContact confirm, void* context)
      : pair_(problem.pairs[pair]),
        body_(problem.bodies[pair_.body]),
        obstacle_(problem.obstacles[pair_.obstacle]),
        pose_(scratch.lane_poses[body_.frame]),
        memory_(scratch.memories[pair]),
        roots_(roots),
        scratch_(scratch),
        margin_(body_.margin + obstacle_.margin + 3.5F * body_.lane_error),
        confirm_(confirm),
        context_(context) {}

  // The lanes among the given ones in which body and obstacle touch.
  unsigned run(unsigned live) {
    live &= ~remembered_free();
    if (live == 0) return 0;
    if (memory_.contact.body >= 0) hits_ = touching(memory_.contact, live);
    settle(live & ~hits_);
    return hits_;
  }

 private:
  void settle(unsigned live) {
    if (live == 0) return;
    const int count = __builtin_popcount(live);
    if (count == 1) {
      settle_alone(__builtin_ctz(live));
      return;
    }
    unsigned upper = live;
    for (int i = 0; i < count / 2; ++i) upper &= upper - 1;
    const int middle = __builtin_ctz(upper);
    const KernelReference at = reference(middle);
    const float needed = displacement(at, live);
    const float widest = memory_.widest * body_.radius;
    if (needed > widest) {
      if (memory_.widest < kWidest) memory_.widest *= kWiden;
      if (needed <= 2.0F * widest) {
        settle(live & ~upper);
        settle(upper);
        return;
      }
      for (; live != 0; live &= live - 1) settle_alone(__builtin_ctz(live));
      return;
    }
    if (memory_.ambition > kProbeFrom && is_apart(at, memory_.ambition * needed)) return;
    if (search_all(at, needed, live)) return;
    settle(live & ~upper);
    settle(upper);
  }

  // Whether the body is apart when grown by more than needed; then the next blocks need no search.
  bool is_apart(const KernelReference& at, float inflation) {
    AnyLeaves any;
    if (search(at, inflation, any)) {
      memory_.ambition = kModest;
      return false;
    }
    remember(at, inflation);
    return true;
  }

  // Settles the lanes from one search; false if there is not room enough for it.
  bool search_all(const KernelReference& from, float inflation, unsigned live) {
    const Placement at = placement(from, inflation);
    LeafSearch search(body_, obstacle_, at, scratch_.queues);
    const bool has_room = search.run();
    const std::int32_t found = search.found().count();
    if (!has_room || found > kManyFound * __builtin_popcount(live)) {
      memory_.widest = 0.5F * inflation / body_.radius;
    }
    if (!has_room) return false;
    if (found == 0) {
      remember(from, inflation);
      return true;
    }
    memory_.ambition = kModest;
    for (std::int32_t i = 0; i < found && live != 0; ++i) {
      const unsigned hits = touching(search.found().pair(i), live);
      if (hits == 0) continue;
      memory_.contact = search.found().pair(i);
      hits_ |= hits;
      live &= ~hits;
    }
    return true;
  }

  // Lanes in which no point of the body has moved by more than what it was grown by where it was
  // apart: (a + b)^2 <= 2 (a^2 + b^2) spares the roots.
  SPHERULE_INLINE unsigned remembered_free() const {
    const float allowed = memory_.inflation - 6.0F * body_.lane_error;
    if (allowed <= 0.0F) return 0;
    const Floats moved = squared_distance(roots_, memory_.pose.center);
    const Floats turned = squared_turn(memory_.pose);
    const float half = body_.radius * body_.radius * 0.5F;
    return at_most(moved + half * turned, 0.5F * allowed * allowed * (2.0F - kLooser));
  }

  void remember(const KernelReference& pose, float inflation) {
    memory_.pose = pose;
    memory_.inflation = inflation;
    if (memory_.ambition < kMostAmbition) memory_.ambition *= 2.0F;
  }

  SPHERULE_INLINE static Placement placement(const KernelReference& from, float inflation) {
    Placement at;
    __builtin_memcpy(at.columns, from.columns, sizeof at.columns);
    at.inflation = inflation;
    return at;
  }

  // A lane's place of the body.
  SPHERULE_INLINE KernelReference reference(int lane) const {
    KernelReference at;
    for (int column = 0; column < 4; ++column) {
      for (int i = 0; i < 3; ++i) at.columns[column][i] = pose_.columns[column][i][lane];
      at.columns[column][3] = 0.0F;
    }
    at.center[0] = reinterpret_cast<const float*>(&roots_.x)[lane];
    at.center[1] = reinterpret_cast<const float*>(&roots_.y)[lane];
    at.center[2] = reinterpret_cast<const float*>(&roots_.z)[lane];
    return at;
  }

  SPHERULE_INLINE static Floats squared_distance(const Vectors& v, const float* w) {
    const Floats x = v.x - w[0];
    const Floats y = v.y - w[1];
    const Floats z = v.z - w[2];
    return x * x + y * y + z * z;
  }

  // Of the difference of the rotations, over all entries.
  SPHERULE_INLINE Floats squared_turn(const KernelReference& from) const {
    return squared_distance(column(pose_, 0), from.columns[0]) +
           squared_distance(column(pose_, 1), from.columns[1]) +
           squared_distance(column(pose_, 2), from.columns[2]);
  }

  // An upper bound of how far any point of the body is in any of the lanes from where it is there.
  SPHERULE_INLINE float displacement(const KernelReference& from, unsigned live) const {
    const float moved = largest(squared_distance(roots_, from.center), live);
    const float turned = largest(squared_turn(from), live);
    return (__builtin_sqrtf(moved) + __builtin_sqrtf(0.5F * turned) * body_.radius) * kLooser +
           6.0F * body_.lane_error;
  }

  template <class Leaves>
  bool search(const KernelReference& from, float inflation, Leaves& leaves) const {
    const Placement at = placement(from, inflation);
    PairSearch<Leaves> pair(body_, obstacle_, at, scratch_.tasks, leaves);
    return pair.run(
        {from.center[0], from.center[1], from.center[2], body_.radius + inflation, 0, 0});
  }

  void settle_alone(int lane) {
    Contact contact(pair_, lane, margin_, confirm_, context_);
    if (search(reference(lane), body_.lane_error, contact)) hits_ |= 1U << lane;
  }

  SPHERULE_INLINE unsigned touching(KernelLeaves leaves, unsigned live) const {
    const PackedSphere& body = body_.leaves[leaves.body];
    const PackedSphere& obstacle = obstacle_.leaves[leaves.obstacle];
    const Vectors center = image(pose_, body.center);
    const Floats dx = center.x - obstacle.center[0];
    const Floats dy = center.y - obstacle.center[1];
    const Floats dz = center.z - obstacle.center[2];
    const Floats squared = dx * dx + dy * dy + dz * dz;
    const float limit = (body.radius + body_.lane_error) + obstacle.radius;
    const unsigned near = at_most(squared, limit * limit) & live;
    if (near == 0) return 0;
    const float sure = limit - margin_;
    unsigned hits = sure > 0.0F ? at_most(squared, sure * sure) & near : 0U;
    for (unsigned uncertain = near & ~hits; uncertain != 0; uncertain &= uncertain - 1) {
      const int lane = __builtin_ctz(uncertain);
      if (confirm_(context_, lane, pair_, leaves.body, leaves.obstacle)) hits |= 1U << lane;
    }
    return hits;
  }

  KernelPair pair_;
  const KernelBody& body_;
  const KernelObstacle& obstacle_;
  const KernelLanePose& pose_;
  KernelMemory& memory_;
  const Vectors roots_;
  const KernelScratch& scratch_;
  float margin_;  // what touches by more does so for sure
  unsigned hits_ = 0;
  ConfirmContact confirm_;
  void* context_;
};

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
