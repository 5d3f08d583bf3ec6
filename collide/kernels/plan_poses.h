// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Kinematics of eight configurations side by side: poses, velocities, centres of nodes. Part of the
// kernels, see plan_kernel_impl.h.
//
// Error budget of poses, v being the unit roundoff (2^-24 or 2^-53). A pair of sine and cosine errs
// by less than 6 v in single precision, by less than 2e-11 in double (vectors.h).
// Of a frame in its parent's, over all nine entries of a rotation (Frobenius), besides the sines:
//   the frame's rotation rounded           2 v
//   product with the parent's              9 v   three terms an entry, 3 v by Cauchy, nine entries
//   turn by the position                   4 v   two terms an entry, 2 v, of two columns
// and of its origin, where W bounds the lengths of the chain together: rounded v W (twice for a
// shift, the position rounded v W more), product and sum 7 v W. A point that the frame carries, at
// no more than W from it, moves by less than 15 v W and 10 v W: 25 v W a frame and the sines' 6 v W
// (2e-11 W), and a fifth more for what the norms of rounded rotations grow by in long chains.
// A centre c in the frame: rounded v |c|, products and sums 7 v (|c| + |t|): less than 12 v W.
//
// Velocities. With rates w_k, axes z_k and origins o_k, that of p is the sum of w_k z_k x (p -
// o_k), summed as at_origin + turning x p. Axes err by the above over W, p and o_k by it: together
// by less than 4 of it for each rate. Rounding of the n + 2 sums and of two products adds less than
// (4 n + 16) v W for each rate, which is below the above, 38 n v W, too: 5 times that in all.

#include "collide/kernels/plan_vectors.h"
#include "collide/search/vectors.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

SPHERULE_INLINE void sine_and_cosine(const Double8& angle, Float8& sine, Float8& cosine) {
  const auto less_quarters = reduced(angle);
  const Float8 r = to_single(less_quarters.remainder);
  const Int8 quarter = to_integers(less_quarters.quarters);
  const Float8 r2 = r * r;
  const auto turned = turned_by(quarter, sine_series(r, r2), cosine_series(r2));
  sine = reinterpret_cast<const Float8&>(turned.sine);
  cosine = reinterpret_cast<const Float8&>(turned.cosine);
}

SPHERULE_INLINE void sine_and_cosine(const Double8& angle, Double8& sine, Double8& cosine) {
  const auto less_quarters = reduced(angle);
  const Double8& r = less_quarters.remainder;
  const Long8 quarter = __builtin_convertvector(less_quarters.quarters, Long8);
  const Double8 r2 = r * r;
  const Double8 s =
      r + r * r2 *
              (-1.0 / 6 + r2 * (1.0 / 120 +
                                r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800)))));
  const Double8 c =
      1.0 - 0.5 * r2 +
      r2 * r2 *
          (1.0 / 24 +
           r2 * (-1.0 / 720 + r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 + r2 * (1.0 / 479001600)))));
  const auto turned = turned_by(quarter, s, c);
  sine = reinterpret_cast<const Double8&>(turned.sine);
  cosine = reinterpret_cast<const Double8&>(turned.cosine);
}

SPHERULE_INLINE Float8 rounded(const Double8& x, float) {
  return to_single(x);
}
SPHERULE_INLINE Double8 rounded(const Double8& x, double) {
  return x;
}

template <class Real>
SPHERULE_INLINE Point<Real> column(const PlanPose<Real>& pose, int which) {
  return load_point(pose.columns[which]);
}

// The image of a vector's coordinates under the columns of a pose, without its origin. Most
// coordinates of most frames are zero.
template <class Real>
SPHERULE_INLINE Point<Real> combined(const PlanPose<Real>& pose, const Real* by) {
  // Coordinate by coordinate: the compiler copies a whole point through memory, in pieces of other
  // sizes than it was written in, which has to wait.
  Point<Real> sum = {all(Real(0)), all(Real(0)), all(Real(0))};
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    if (by[i] == Real(0)) continue;
    sum.x += by[i] * load(pose.columns[i][0]);
    sum.y += by[i] * load(pose.columns[i][1]);
    sum.z += by[i] * load(pose.columns[i][2]);
  }
  return sum;
}

// The positions in the middles of the parts.
template <class Real>
SPHERULE_INLINE void place_middles(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch,
                                   const PlanParts& parts) {
  const Double8 at = load(parts.middle);
  const Double8 before = 1.0 - at;
  for (std::int32_t i = 0; i < plan.position_count; ++i) {
    store<double>(before * scratch.from[i] + at * scratch.to[i], scratch.positions[i].lane);
  }
}

// The poses of all frames.
template <class Real>
SPHERULE_INLINE void place_frames(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch) {
  PlanPose<Real>& base = scratch.poses[0];
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) store(all(i == j ? Real(1) : Real(0)), base.columns[i][j]);
  }
  for (std::int32_t f = 1; f < plan.frame_count; ++f) {
    const PlanFrame<Real>& frame = plan.frames[f];
    const PlanPose<Real>& parent = scratch.poses[frame.parent];
    PlanPose<Real>& pose = scratch.poses[f];
    const Point<Real> m0 = combined(parent, frame.rotation[0]);
    const Point<Real> m1 = combined(parent, frame.rotation[1]);
    const Point<Real> m2 = combined(parent, frame.rotation[2]);
    const Point<Real> origin = combined(parent, frame.origin) + column(parent, 3);
    const Double8 position = load(scratch.positions[frame.position].lane);
    store_point(m2, pose.columns[2]);
    if (frame.prismatic) {
      const Vector<Real> shift = rounded(position, Real());
      store_point(m0, pose.columns[0]);
      store_point(m1, pose.columns[1]);
      store_point<Real>({origin.x + shift * m2.x, origin.y + shift * m2.y, origin.z + shift * m2.z},
                        pose.columns[3]);
      continue;
    }
    Vector<Real> s, c;
    sine_and_cosine(position, s, c);
    store_point<Real>({c * m0.x + s * m1.x, c * m0.y + s * m1.y, c * m0.z + s * m1.z},
                      pose.columns[0]);
    store_point<Real>({c * m1.x - s * m0.x, c * m1.y - s * m0.y, c * m1.z - s * m0.z},
                      pose.columns[1]);
    store_point(origin, pose.columns[3]);
  }
}

// The velocities of all frames.
template <class Real>
SPHERULE_INLINE void place_twists(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch) {
  for (int i = 0; i < 3; ++i) {
    store(all(Real(0)), scratch.twists[0].turning[i]);
    store(all(Real(0)), scratch.twists[0].at_origin[i]);
  }
  for (std::int32_t f = 1; f < plan.frame_count; ++f) {
    const PlanFrame<Real>& frame = plan.frames[f];
    const PlanTwist<Real>& parent = scratch.twists[frame.parent];
    PlanTwist<Real>& twist = scratch.twists[f];
    const Point<Real> rate = scratch.rates[frame.position] * column(scratch.poses[f], 2);
    const Point<Real> turning = load_point(parent.turning);
    const Point<Real> at_origin = load_point(parent.at_origin);
    if (frame.prismatic) {
      store_point(turning, twist.turning);
      store_point(at_origin + rate, twist.at_origin);
    } else {
      store_point(turning + rate, twist.turning);
      store_point(at_origin + cross(column(scratch.poses[f], 3), rate), twist.at_origin);
    }
  }
}

// The centre of a body's node; computed once an evaluation.
template <class Real>
SPHERULE_INLINE Point<Real> center_of(const PlanScratch<Real>& scratch, const PlanBody<Real>& body,
                                      std::int32_t node) {
  const std::int32_t index = body.first_center + node;
  PlanCenter<Real>& center = scratch.centers[index];
  if (scratch.placed[index] == *scratch.evaluation) return load_point(center.at);
  scratch.placed[index] = *scratch.evaluation;
  const PlanPose<Real>& pose = scratch.poses[body.frame];
  const Real* const c = body.nodes[node].center;
  const Point<Real> at = c[0] * column(pose, 0) +
                         (c[1] * column(pose, 1) + (c[2] * column(pose, 2) + column(pose, 3)));
  store_point(at, center.at);
  return at;
}

template <class Real>
SPHERULE_INLINE Point<Real> velocity_of(const PlanTwist<Real>& twist, const Point<Real>& p) {
  return load_point(twist.at_origin) + cross(load_point(twist.turning), p);
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

// Whether positions lie in free cells of a pair (plan_trees.h). Part of the kernels, see
// plan_kernel_impl.h.
//
// Coordinates are computed in double: those of positions up to 100 err by less than 1e-13 of a
// cell, for which plan_trees.cpp has room.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

SPHERULE_INLINE bool is_in_free_cell(const PlanFreeCells& cells, const double* positions) {
  if (cells.words == nullptr) return false;
  const double i = (positions[cells.position[0]] - cells.lower[0]) * cells.scale[0];
  const double j = (positions[cells.position[1]] - cells.lower[1]) * cells.scale[1];
  constexpr double kEnd = PlanFreeCells::kCells;
  if (!(i >= 0.0 && i < kEnd && j >= 0.0 && j < kEnd)) return false;
  return (cells.words[static_cast<int>(j)] >> static_cast<int>(i) & 1U) != 0;
}

// Those of the lanes whose configurations lie in free cells, or with `parts` all of the part.
template <class Real, bool kMoves>
unsigned lanes_in_free_cells(const PlanFreeCells& cells, const PlanScratch<Real>& scratch,
                             const PlanParts* parts, unsigned lanes) {
  if (cells.words == nullptr) return 0;
  alignas(64) std::int32_t first[2][kPlanLanes];
  alignas(64) std::int32_t last[2][kPlanLanes];
  for (int k = 0; k < 2; ++k) {
    const std::int32_t p = cells.position[k];
    const Double8 offset = load(scratch.positions[p].lane) - cells.lower[k];
    Double8 low = offset * cells.scale[k];
    Double8 high = low;
    if constexpr (kMoves) {
      const double rate = scratch.to[p] - scratch.from[p];
      const Double8 way =
          load(parts->half) * ((rate < 0.0 ? -rate : rate) * (1.0 + 0x1p-40)) + 1e-12;
      low = (offset - way) * cells.scale[k];
      high = (offset + way) * cells.scale[k];
    }
    lanes &= ~above(Double8{}, low) & above(all(double{PlanFreeCells::kCells}), high);
    if (lanes == 0) return 0;
    *reinterpret_cast<Int8*>(first[k]) = to_integers(low);
    if (kMoves) *reinterpret_cast<Int8*>(last[k]) = to_integers(high);
  }
  unsigned free = 0;
  for (unsigned left = lanes; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    const std::int32_t i = first[0][lane];
    if constexpr (kMoves) {
      const std::uint64_t bits = ~std::uint64_t{0} >> (63 - (last[0][lane] - i)) << i;
      std::uint64_t missing = 0;
      for (std::int32_t j = first[1][lane]; j <= last[1][lane]; ++j) {
        missing |= bits & ~cells.words[j];
      }
      if (missing == 0) free |= 1U << lane;
    } else {
      free |= static_cast<unsigned>(cells.words[first[1][lane]] >> i & 1U) << lane;
    }
  }
  return free;
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
