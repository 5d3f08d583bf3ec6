// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Eight numbers side by side, in single or double precision. Part of the kernels, see
// plan_kernel_impl.h.

#include "collide/kernels/check_plan.h"
#include "collide/search/vectors.h"

#include <cstdint>
#include <type_traits>

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

typedef double Double8 __attribute__((vector_size(64), may_alias));
typedef std::int64_t Long8 __attribute__((vector_size(64), may_alias));

template <class Real>
struct VectorOf;
template <>
struct VectorOf<float> {
  using Type = Float8;
  using Bits = Int8;
};
template <>
struct VectorOf<double> {
  using Type = Double8;
  using Bits = Long8;
};
template <class Real>
using Vector = typename VectorOf<Real>::Type;
template <class Real>
using Bits = typename VectorOf<Real>::Bits;

constexpr unsigned kAllLanes = (1U << kPlanLanes) - 1;

SPHERULE_INLINE Double8 load(const double* p) {
  return *reinterpret_cast<const Double8*>(p);
}

template <class Real>
SPHERULE_INLINE void store(const Vector<Real>& x, Real* p) {
  *reinterpret_cast<Vector<Real>*>(p) = x;
}

template <class Real>
SPHERULE_INLINE Vector<Real> all(Real x) {
  return x - Vector<Real>{};
}

// A bit for every lane of a that is above that of b.
SPHERULE_INLINE unsigned above(const Float8& a, const Float8& b) {
#if defined(__AVX512VL__)
  return _mm256_cmp_ps_mask(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), _CMP_GT_OQ);
#else
  return mask_of(a > b);
#endif
}
SPHERULE_INLINE unsigned above(const Double8& a, const Double8& b) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), _CMP_GT_OQ);
#else
  return bits_of_lanes(a > b);
#endif
}

template <class V>
SPHERULE_INLINE V larger(const V& a, const V& b) {
  return a > b ? a : b;
}
template <class V>
SPHERULE_INLINE V smaller(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
SPHERULE_INLINE V root(const V& a) {
  V result = {};
  for (int lane = 0; lane < kPlanLanes; ++lane) {
    if constexpr (sizeof(a[0]) == sizeof(float)) {
      result[lane] = __builtin_sqrtf(a[lane]);
    } else {
      result[lane] = __builtin_sqrt(a[lane]);
    }
  }
  return result;
}
// By name: the compiler finds the instructions for doubles only.
#if defined(__AVX__)
SPHERULE_INLINE Float8 larger(const Float8& a, const Float8& b) {
  return reinterpret_cast<Float8>(
      _mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
SPHERULE_INLINE Float8 smaller(const Float8& a, const Float8& b) {
  return reinterpret_cast<Float8>(
      _mm256_min_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
SPHERULE_INLINE Float8 root(const Float8& a) {
  return reinterpret_cast<Float8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
}
#endif

// To single precision, and whole numbers to integers. By name: what the compiler makes of
// __builtin_convertvector goes through memory in halves, which has to wait.
SPHERULE_INLINE Float8 to_single(const Double8& x) {
#if defined(__AVX512F__)
  return reinterpret_cast<Float8>(_mm512_maskz_cvtpd_ps(0xFF, reinterpret_cast<__m512d>(x)));
#elif defined(__AVX__)
  __m256d halves[2];
  __builtin_memcpy(halves, &x, sizeof halves);
  return reinterpret_cast<Float8>(
      _mm256_set_m128(_mm256_cvtpd_ps(halves[1]), _mm256_cvtpd_ps(halves[0])));
#else
  return __builtin_convertvector(x, Float8);
#endif
}
SPHERULE_INLINE Int8 to_integers(const Double8& x) {
#if defined(__AVX512F__)
  return reinterpret_cast<Int8>(_mm512_maskz_cvttpd_epi32(0xFF, reinterpret_cast<__m512d>(x)));
#elif defined(__AVX__)
  __m256d halves[2];
  __builtin_memcpy(halves, &x, sizeof halves);
  return reinterpret_cast<Int8>(
      _mm256_set_m128i(_mm256_cvttpd_epi32(halves[1]), _mm256_cvttpd_epi32(halves[0])));
#else
  return __builtin_convertvector(x, Int8);
#endif
}

template <class V>
SPHERULE_INLINE V magnitude(const V& a) {
  return larger(a, -a);
}

// The magnitude of a with the sign of b.
template <class V>
SPHERULE_INLINE V with_sign(const V& a, const V& b) {
  const V negative = -V{};
  Bits<std::remove_cvref_t<decltype(a[0])>> bits[3];
  __builtin_memcpy(&bits[0], &a, sizeof a);
  __builtin_memcpy(&bits[1], &b, sizeof b);
  __builtin_memcpy(&bits[2], &negative, sizeof negative);
  bits[0] |= bits[1] & bits[2];
  V result;
  __builtin_memcpy(&result, &bits[0], sizeof result);
  return result;
}

SPHERULE_INLINE float lowest(const Float8& a) {
#if defined(__AVX__)
  const auto x = reinterpret_cast<__m256>(a);
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
#else
  float result = a[0];
  for (int lane = 1; lane < kPlanLanes; ++lane) result = a[lane] < result ? a[lane] : result;
  return result;
#endif
}
SPHERULE_INLINE double lowest(const Double8& a) {
  double result = a[0];
  for (int lane = 1; lane < kPlanLanes; ++lane) result = a[lane] < result ? a[lane] : result;
  return result;
}
template <class V>
SPHERULE_INLINE auto highest(const V& a) {
  return -lowest(-a);
}

// In the lanes that are not given a number below all coordinates.
template <class Real>
SPHERULE_INLINE Vector<Real> only(unsigned lanes, const Vector<Real>& a) {
  constexpr Real kBelowAll = Real(-1e30);
  const Bits<Real> bits = {1, 2, 4, 8, 16, 32, 64, 128};
  return (bits & (Bits<Real>{} + static_cast<int>(lanes))) != 0 ? a : all(kBelowAll);
}

// Puts a test to the front of the list.
SPHERULE_INLINE void remember(PlanRecent& recent, std::int32_t test) {
  std::int32_t place = 0;
  while (place < recent.count && recent.tests[place] != test) ++place;
  if (place == recent.count) {
    if (recent.count < PlanRecent::kMost) ++recent.count;
    place = recent.count - 1;
  }
  for (; place > 0; --place) recent.tests[place] = recent.tests[place - 1];
  recent.tests[0] = test;
}

// Three coordinates.
template <class Real>
struct Point {
  Vector<Real> x, y, z;
};

template <class Real>
SPHERULE_INLINE Point<Real> load_point(const Real (*at)[kPlanLanes]) {
  return {load(at[0]), load(at[1]), load(at[2])};
}

template <class Real>
SPHERULE_INLINE void store_point(const Point<Real>& p, Real (*at)[kPlanLanes]) {
  store(p.x, at[0]);
  store(p.y, at[1]);
  store(p.z, at[2]);
}

template <class Real>
SPHERULE_INLINE Vector<Real> dot(const Point<Real>& a, const Point<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
SPHERULE_INLINE Point<Real> operator-(const Point<Real>& a, const Point<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Real>
SPHERULE_INLINE Point<Real> operator+(const Point<Real>& a, const Point<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Real>
SPHERULE_INLINE Point<Real> operator*(Real a, const Point<Real>& p) {
  return {a * p.x, a * p.y, a * p.z};
}

template <class Real>
SPHERULE_INLINE Point<Real> constant(const Real* p) {
  return {all(p[0]), all(p[1]), all(p[2])};
}

template <class Real>
SPHERULE_INLINE Point<Real> cross(const Point<Real>& a, const Point<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

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
// robot/model/link_paths.cpp) and of the largest shift of each prismatic joint before it.
//
// Rounding. No term is negative. A sum over n joints of rates times sums over n joints errs by
// less than (3 n + 8) v of itself, v being the unit roundoff of Real: bound_slack exceeds that.

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
