// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Bounds of the speed and the acceleration of bodies against the root and against each other (for
// G6), eight at a time. Part of the kernels, see plan_kernel_impl.h.
//
// Of the joints that lie on the way from one body to the other only these matter, whatever moves
// both. Let them be numbered from the first body on, and let joint k change at the constant rate
// w_k. Look from the link behind joint s at a point p of the first body, which joints 1 to s move:
// joint k, that is, takes with it all that is on the first body's side of it. Let z_k be its axis
// and o_k a point of that. With the joint's position x_k,
//     dp / dx_k = z_k x (p - o_k), or z_k for a shift;
//     d2p / dx_j dx_k = z_j x (dp / dx_k) for j >= k if joint j turns, otherwise 0,
// because joint j, nearer to the observer, turns all of what k does. Neither is longer than
// r_k, the distance of p from the axis of k, or 1 for a shift. So the speed of p is at most the sum
// of w_k r_k, and its acceleration at most the sum over k of
//     w_k r_k (w_k t_k + 2 (w_(k+1) t_(k+1) + ... + w_s t_s)),
// t_j being 1 if joint j turns, otherwise 0. PathSum adds what joint j contributes to half of that:
//     w_j t_j (w_j r_j / 2 + w_1 r_1 + ... + w_(j-1) r_(j-1)).
// The same holds for the second body from the other side, and the motion of a point of one as seen
// from a point of the other, in the directions of the link behind s, is at most both together. Any
// s will do, and the smallest sum over all counts. Against the root s is behind the last joint.
//
// r_k is at most the sum of what the step has without shifts (the proof is in
// robot/model/internal/path_reach.cpp) and of the largest shift of each prismatic joint before it.
//
// Rounding. No term is negative. A sum over n joints of rates times sums over n joints errs by
// less than (3 n + 8) v of itself, v being the unit roundoff of Real: bound_slack exceeds that.

#include "collide/kernels/plan_vectors.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

SPHERULE_INLINE Float8 gathered(const float* from, const std::int32_t* index) {
#if defined(__AVX2__)
  return reinterpret_cast<Float8>(
      _mm256_i32gather_ps(from, *reinterpret_cast<const __m256i*>(index), 4));
#else
  return Float8{from[index[0]], from[index[1]], from[index[2]], from[index[3]],
                from[index[4]], from[index[5]], from[index[6]], from[index[7]]};
#endif
}
SPHERULE_INLINE Double8 gathered(const double* from, const std::int32_t* index) {
  return Double8{from[index[0]], from[index[1]], from[index[2]], from[index[3]],
                 from[index[4]], from[index[5]], from[index[6]], from[index[7]]};
}

template <class Real>
struct PathSum {
  Vector<Real> speed{};
  Vector<Real> bend{};
  Vector<Real> shifted{};

  // One more joint is passed.
  SPHERULE_INLINE void pass(const PlanPathStep<Real>& step, const Real* reach,
                            const PlanScratch<Real>& scratch, bool slides) {
    const Vector<Real> rate = gathered(scratch.speeds, step.position);
    if (!slides) {
      const Vector<Real> travel = rate * load(reach);
      bend += rate * (Real(0.5) * travel + speed);
      speed += travel;
      return;
    }
    const Vector<Real> turns = load(step.turns);
    const Vector<Real> travel = rate * (load(reach) + turns * shifted);
    bend += turns * rate * (Real(0.5) * travel + speed);
    speed += travel;
    shifted += load(step.slides) * gathered(scratch.shifts, step.position);
  }
};

// To the root: as seen from there.
template <class Real>
SPHERULE_INLINE void bound_bodies(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch) {
  for (std::int32_t first = 0, g = 0; first < plan.body_count; first += kPlanLanes, ++g) {
    const PlanPathGroup& group = plan.body_paths[g];
    PathSum<Real> sum;
    for (std::int32_t k = 0; k < group.step_count; ++k) {
      const PlanPathStep<Real>& step = plan.steps[group.first_step + k];
      sum.pass(step, step.first, scratch, plan.slides);
    }
    const std::int32_t count = plan.body_count - first;
    for (std::int32_t lane = 0; lane < kPlanLanes && lane < count; ++lane) {
      scratch.body_bounds[first + lane] = {sum.speed[lane] * plan.bound_slack,
                                           sum.bend[lane] * plan.bound_slack};
    }
  }
}

// Of the pairs in a group, from one body to the other, seen from whichever link between gives the
// least.
template <class Real>
SPHERULE_INLINE void bound_pairs(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch,
                                 std::int32_t index) {
  const PlanPathGroup& group = plan.pair_paths[index];
  PathSum<Real> second;
  PlanNumbers<Real>* const work = scratch.path_work;  // of the second body, behind each joint
  store(second.speed, work[2 * group.step_count].lane);
  store(second.bend, work[2 * group.step_count + 1].lane);
  for (std::int32_t k = group.step_count; k-- > 0;) {
    const PlanPathStep<Real>& step = plan.steps[group.first_step + k];
    second.pass(step, step.second, scratch, plan.slides);
    store(second.speed, work[2 * k].lane);
    store(second.bend, work[2 * k + 1].lane);
  }
  Vector<Real> speed = load(work[0].lane);
  Vector<Real> bend = load(work[1].lane);
  PathSum<Real> sum;
  for (std::int32_t k = 0; k < group.step_count; ++k) {
    const PlanPathStep<Real>& step = plan.steps[group.first_step + k];
    sum.pass(step, step.first, scratch, plan.slides);
    speed = smaller(speed, sum.speed + load(work[2 * k + 2].lane));
    bend = smaller(bend, sum.bend + load(work[2 * k + 3].lane));
  }
  const std::int32_t first = index * kPlanLanes;
  for (std::int32_t lane = 0; lane < kPlanLanes && first + lane < plan.pair_count; ++lane) {
    scratch.pair_bounds[first + lane] = {speed[lane] * plan.bound_slack,
                                         bend[lane] * plan.bound_slack};
  }
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
