// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One sphere against the consecutive spheres of a structure of arrays: the inner loop of every
// query. All variants do the same double operations in the same order, lane by lane, so they give
// the same bits. Kernels for wider instruction sets belong here, behind these functions.

#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace spherule::internal {

// Spheres first, first + 1, ... of a tree.
struct SphereArrays {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
};

// A sphere in the frame of the arrays; the pad of the test is part of its radius.
struct QuerySphere {
  double x, y, z, radius;
};

inline bool overlaps(const SphereArrays& spheres, std::int32_t i, const QuerySphere& q) {
  const double dx = spheres.x[i] - q.x;
  const double dy = spheres.y[i] - q.y;
  const double dz = spheres.z[i] - q.z;
  const double limit = q.radius + spheres.radius[i];
  return dx * dx + dy * dy + dz * dz <= limit * limit;
}

// Bit i is set if sphere first + i overlaps `q`; 1 <= count <= 32. For any machine.
inline std::uint32_t portable_overlap_mask(const SphereArrays& spheres, std::int32_t first,
                                           std::int32_t count, const QuerySphere& q) {
  std::uint32_t mask = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    mask |= static_cast<std::uint32_t>(overlaps(spheres, first + i, q)) << i;
  }
  return mask;
}

// The same, as fast as this machine can.
inline std::uint32_t overlap_mask(const SphereArrays& spheres, std::int32_t first,
                                  std::int32_t count, const QuerySphere& q) {
#if defined(__SSE2__)
  if (count == 1) return overlaps(spheres, first, q) ? 1u : 0u;
  const __m128d qx = _mm_set1_pd(q.x);
  const __m128d qy = _mm_set1_pd(q.y);
  const __m128d qz = _mm_set1_pd(q.z);
  const __m128d qr = _mm_set1_pd(q.radius);
  std::uint32_t mask = 0;
  for (std::int32_t done = 0; done < count; done += 2) {
    // An odd count tests its last but one sphere twice, rather than read past the end.
    const std::int32_t lane = done + 2 <= count ? done : count - 2;
    const std::int32_t i = first + lane;
    const __m128d dx = _mm_sub_pd(_mm_loadu_pd(spheres.x + i), qx);
    const __m128d dy = _mm_sub_pd(_mm_loadu_pd(spheres.y + i), qy);
    const __m128d dz = _mm_sub_pd(_mm_loadu_pd(spheres.z + i), qz);
    const __m128d limit = _mm_add_pd(qr, _mm_loadu_pd(spheres.radius + i));
    const __m128d d2 =
        _mm_add_pd(_mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy)), _mm_mul_pd(dz, dz));
    const int bits = _mm_movemask_pd(_mm_cmple_pd(d2, _mm_mul_pd(limit, limit)));
    mask |= static_cast<std::uint32_t>(bits) << lane;
  }
  return mask;
#else
  return portable_overlap_mask(spheres, first, count, q);
#endif
}

// gaps[i] = distance of the centres minus both radii (negative where they overlap).
inline void sphere_gaps(const SphereArrays& spheres, std::int32_t first, std::int32_t count,
                        const QuerySphere& q, double* gaps) {
  for (std::int32_t i = 0; i < count; ++i) {
    const double dx = spheres.x[first + i] - q.x;
    const double dy = spheres.y[first + i] - q.y;
    const double dz = spheres.z[first + i] - q.z;
    gaps[i] = std::sqrt(dx * dx + dy * dy + dz * dz) - (q.radius + spheres.radius[first + i]);
  }
}

}  // namespace spherule::internal
