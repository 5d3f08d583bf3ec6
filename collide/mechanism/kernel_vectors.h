// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Vectors of eight numbers. Part of all kernels, for the instruction set that SPHERULE_KERNEL
// names.

#include <cstdint>

#ifdef __x86_64__
#include <immintrin.h>
#endif

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

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
