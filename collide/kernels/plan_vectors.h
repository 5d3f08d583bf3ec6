// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Eight numbers side by side, in single or double precision. Part of the kernels, see
// plan_kernel_impl.h.

#include "collide/kernels/check_plan.h"
#include "collide/mechanism/kernel_vectors.h"

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
