// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Vectors of eight numbers. Part of all kernels, for the instruction set that SPHERULE_KERNEL
// names.

#include "collide/search/packed_tree.h"

#include <cstdint>

#ifdef __x86_64__
#include <immintrin.h>
#endif

// Every function with vectors is inlined or local: none crosses a boundary between files.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

#define SPHERULE_INLINE inline __attribute__((always_inline))

typedef float Float8 __attribute__((vector_size(32), may_alias));
typedef std::int32_t Int8 __attribute__((vector_size(32), may_alias));

SPHERULE_INLINE Float8 load(const float* p) {
  return *reinterpret_cast<const Float8*>(p);
}

// A bit for every lane of a comparison that is set. A branch: g++ 12 with -fsanitize=undefined
// loses bits of `(set[lane] != 0 ? 1U : 0U) << lane`.
template <class Comparison>
SPHERULE_INLINE unsigned bits_of_lanes(const Comparison& set) {
  unsigned mask = 0;
  for (int lane = 0; lane < 8; ++lane) {
    if (set[lane] != 0) mask |= 1U << lane;
  }
  return mask;
}

SPHERULE_INLINE unsigned mask_of(const Int8& set) {
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(set)));
#elif defined(__SSE2__)
  __m128 halves[2];
  __builtin_memcpy(halves, &set, sizeof halves);
  return static_cast<unsigned>(_mm_movemask_ps(halves[0]) | _mm_movemask_ps(halves[1]) << 4);
#else
  return bits_of_lanes(set);
#endif
}

// Eight spheres.
struct Spheres {
  Float8 x, y, z, radius;
};

// To memory, where single lanes are read.
SPHERULE_INLINE void hold(const Spheres& spheres, KernelSpheres& lanes) {
  __builtin_memcpy(lanes.x, &spheres.x, sizeof lanes.x);
  __builtin_memcpy(lanes.y, &spheres.y, sizeof lanes.y);
  __builtin_memcpy(lanes.z, &spheres.z, sizeof lanes.z);
  __builtin_memcpy(lanes.radius, &spheres.radius, sizeof lanes.radius);
}

template <class Lanes>
SPHERULE_INLINE Spheres spheres_of(const Lanes& node) {
  return {load(node.x), load(node.y), load(node.z), load(node.radius)};
}

SPHERULE_INLINE unsigned overlaps(const Spheres& spheres, float x, float y, float z, float radius) {
  const Float8 dx = spheres.x - x;
  const Float8 dy = spheres.y - y;
  const Float8 dz = spheres.z - z;
  const Float8 limit = spheres.radius + radius;
  return mask_of(dx * dx + dy * dy + dz * dz <= limit * limit);
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

// Sines and cosines of angles side by side, in vectors of any length. Part of all kernels, for the
// instruction set that SPHERULE_KERNEL names.
//
// Error budget. Angles are reduced in double: of an angle x with |x| <= 100
// (kLargestPosition), k = x 2 / pi rounded is at most 64, and x - k pi / 2 in two
// steps errs by less than 64 (2^-53 + 2^-106 ...) < 2e-14; the remainder lies within pi / 4 +
// 1e-13.
//   Single, v = 2^-24: rounding the remainder costs 0.8 v. The sine's series up to r^9 errs by
//   r^11 / 11! < 0.03 v, the cosine's up to r^8 by r^10 / 10! < 0.42 v, their evaluation by less
//   than 3 v: each by less than 4 v, the pair by less than 6 v.
//   Double: the sine's series up to r^11 errs by r^13 / 13! < 7.0e-12, the cosine's up to r^12 by
//   r^14 / 14! < 4e-13, a few roundings of numbers below one, in whatever order the terms are
//   summed, by 1e-15: each by less than 7.1e-12, the pair by less than kSineError = 2e-11.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// Of an angle x, k = x kTwoOverPi is rounded by adding and subtracting kRound, which leaves an
// integer in the last bits, and x - k kHalfPi - k kHalfPiRest remains. Adding 1.5 2^52 rounds to an
// integer only where double is not computed with more bits.
static_assert(__FLT_EVAL_METHOD__ == 0);
constexpr double kRound = 0x1.8p52;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr double kHalfPi = 0x1.921fb54442d18p+0;
constexpr double kHalfPiRest = 0x1.1a62633145c07p-54;

// Angles less the nearest multiple of pi / 2.
template <class Doubles>
struct Reduced {
  Doubles remainder;
  Doubles quarters;  // k, a whole number
  Doubles shifted;   // k + kRound, which has k in its last bits
};

template <class Doubles>
SPHERULE_INLINE Reduced<Doubles> reduced(const Doubles& angle) {
  const Doubles shifted = angle * kTwoOverPi + kRound;
  const Doubles k = shifted - kRound;
  return {(angle - k * kHalfPi) - k * kHalfPiRest, k, shifted};
}

// The series for remainders in single precision, r2 being r r.
template <class Floats>
SPHERULE_INLINE Floats sine_series(const Floats& r, const Floats& r2) {
  return r + r * r2 * (-1.0F / 6 + r2 * (1.0F / 120 + r2 * (-1.0F / 5040 + r2 * (1.0F / 362880))));
}
template <class Floats>
SPHERULE_INLINE Floats cosine_series(const Floats& r2) {
  return 1.0F - 0.5F * r2 + r2 * r2 * (1.0F / 24 + r2 * (-1.0F / 720 + r2 * (1.0F / 40320)));
}

// The bits of sine and cosine, exchanged and signed for the quarter of the turn.
template <class Bits>
struct SineAndCosine {
  Bits sine, cosine;
};
template <class Floats, class Bits>
SPHERULE_INLINE SineAndCosine<Bits> turned_by(const Bits& quarter, const Floats& sine,
                                              const Floats& cosine) {
  constexpr int kShift = sizeof(quarter[0]) * 8 - 2;
  const Bits odd = -(quarter & 1);
  Bits s, c;
  __builtin_memcpy(&s, &sine, sizeof s);
  __builtin_memcpy(&c, &cosine, sizeof c);
  return {((s & ~odd) | (c & odd)) ^ ((quarter & 2) << kShift),
          ((c & ~odd) | (s & odd)) ^ (((quarter + 1) & 2) << kShift)};
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
