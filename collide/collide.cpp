// SPDX-License-Identifier: BSD-3-Clause
#include "collide/collide.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/motion/free_time.h"
#include "collide/pair_cache.h"
#include "collide/search/box_gap.h"
#include "collide/search/nearest_first.h"
#include "collide/search/queries.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace spherule {

bool collides(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
              const Pose& world_from_b) noexcept {
  if (internal::far_apart(a, world_from_a, b, world_from_b)) return false;
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  if (internal::boxes_apart(a, b, pose)) return false;
  return internal::any_pair(a, b, pose, internal::SphereLeaves(a, b, pose));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  return internal::all_pairs(a, b, pose, internal::SphereLeaves(a, b, pose), request);
}

bool spheres_touch(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                   const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b) noexcept {
  return internal::RelativePose(a, world_from_a, b, world_from_b)
      .touches(a.spheres()[static_cast<std::size_t>(sphere_a)],
               b.spheres()[static_cast<std::size_t>(sphere_b)]);
}

double collision_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                       const Pose& world_from_b) noexcept {
  return internal::RelativePose(a, world_from_a, b, world_from_b).slack();
}

DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  const internal::SphereLeaves leaves(a, b, pose);
  const internal::PairSpace space(a, b, pose, leaves);
  return internal::NearestFirst(space, pose.gap_error(), request)
      .run(internal::NodePair(0, 0), pose.gap(a.sphere(0), b.sphere(0)));
}

void require_clearance(double clearance) {
  if (!(clearance >= 0.0 && clearance <= kMaxCoordinate)) {
    throw Error("clearance", "it is not a number from 0 to 1e15");
  }
}

bool within(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  if (internal::far_apart(a, world_from_a, b, world_from_b, clearance)) return false;
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  if (internal::boxes_apart(a, b, pose, clearance)) return false;
  return internal::any_pair_within(a, b, pose, internal::SphereLeaves(a, b, pose, clearance),
                                   clearance);
}

bool spheres_within(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                    const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b,
                    double clearance) {
  require_clearance(clearance);
  return internal::RelativePose(a, world_from_a, b, world_from_b)
      .touches(a.spheres()[static_cast<std::size_t>(sphere_a)],
               b.spheres()[static_cast<std::size_t>(sphere_b)], clearance);
}

double within_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                    const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return internal::RelativePose(a, world_from_a, b, world_from_b).slack(clearance);
}

}  // namespace spherule

// Why a remembered answer is that of collides(), u = 2^-53. Seen from the other set, a centre p of
// the moving one, |p| <= reach, has gone from R0 p + t0 to R1 p + t1: a way of at most
//     |R1 - R0| |p| + |t1 - t0|.
// The difference of two rotations has the singular values s, s, 0, so its norm is its Frobenius
// norm over sqrt(2). The computed frames err by 129 u in that norm and by 71 u |d| in t
// (relative_pose.h), d the offset of the frames, which is below the scene size S. The gap of two
// spheres shrinks by no more than the way. If it was at least the clearance then, and clearance -
// way exceeds the slack of the canonical test now, no pair is accepted: collides() answers false.

namespace spherule {
namespace {

// Clearances are searched for up to so many times the way of one query: what is larger makes a
// search dearer, what is smaller makes searches more frequent.
constexpr double kStepsAhead = 16.0;
// Where fewer steps than these fit into the clearance, it is not worth the search.
constexpr double kUsefulSteps = 2.0;
// In place of a first step, as a part of the reach of the smaller set.
constexpr double kFirstStep = 1.0 / 1024.0;

// Makes FreeTime measure clearance: pairs approach by 1 per unit of time.
struct UnitRate {
  double approach(const Sphere&, const Sphere&, double time) const { return time; }
  double free_time(const Eigen::Vector3d&, const Eigen::Vector3d&, double gap) const { return gap; }
};

}  // namespace

PairCache::PairCache(const SphereTree& a, const SphereTree& b)
    : a_(a), b_(b), a_moves_(a.reach() <= b.reach()), reach_(std::min(a.reach(), b.reach())) {
  require_rounding_to_nearest();
}

double PairCache::way_between(const Seen& before, const Seen& now) const {
  std::array<double, 12> change;
  for (std::size_t i = 0; i < 12; ++i) {
    change[i] = now.other_from_mover[i] - before.other_from_mover[i];
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < 9; ++i) squares += change[i] * change[i];
  // 0.70711 > 1 / sqrt(2) by 4e-6 of it, far more than the roundings of the norm. Twice 129 u over
  // sqrt(2) are 182.5 u.
  const double turned = (0.70711 * std::sqrt(squares) + 200.0 * kUnitRoundoff) * reach_;
  const double shifted = norm_upper({change[9], change[10], change[11]});
  const double frames = 80.0 * kUnitRoundoff * (now.scene_size + before.scene_size);
  return (turned + shifted + frames) * kRelativeUp + kUnderflow;
}

bool PairCache::collides(const Pose& world_from_a, const Pose& world_from_b) {
  ++counts_.queries;
  ++queries_since_;
  const internal::RelativePose pose(a_, world_from_a, b_, world_from_b);
  if (witness_) {
    if (pose.touches(a_.spheres()[static_cast<std::size_t>(witness_->a)],
                     b_.spheres()[static_cast<std::size_t>(witness_->b)])) {
      ++counts_.collisions_from_memory;
      return true;
    }
    witness_.reset();
  }
  const internal::FrameChange frame = a_moves_ ? pose.b_from_a() : pose.a_from_b();
  Seen now{{}, pose.scene_size(), 0.0};
  std::copy(frame.r, frame.r + 9, now.other_from_mover.begin());
  std::copy(frame.t, frame.t + 3, now.other_from_mover.begin() + 9);
  double step = kFirstStep * reach_;
  if (before_) {
    const double way = way_between(*before_, now);
    if (sub_down(before_->clearance, way) > pose.slack()) {
      ++counts_.free_from_memory;
      return false;
    }
    step = way / static_cast<double>(queries_since_);
  }

  internal::Limits no_limits{std::numeric_limits<std::uint64_t>::max(),
                             internal::Deadline(std::chrono::nanoseconds::max()),
                             {}};
  const internal::Evaluation evaluation =
      internal::FreeTime(a_, b_, pose, UnitRate(), 0.0, 0.0, kStepsAhead * step,
                         kUsefulSteps * step, no_limits)
          .run(std::nullopt);
  if (evaluation.contact) witness_ = evaluation.pair;
  now.clearance = evaluation.free_time;
  before_ = now;
  queries_since_ = 0;
  return evaluation.contact;
}

}  // namespace spherule
