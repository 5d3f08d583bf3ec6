// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One ball against the consecutive balls of a structure of arrays: the inner loop of every query.
// All variants do the same double operations in the same order, lane by lane, so they give the same
// bits. Kernels for wider instruction sets belong here, behind these functions.

#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace spherule::internal {

// Balls first, first + 1, ... of a tree.
struct BallArrays {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
};

// A ball in the frame of the arrays; the pad of the test is part of its radius.
struct QueryBall {
  double x, y, z, radius;
};

inline bool overlaps(const BallArrays& balls, std::int32_t i, const QueryBall& q) {
  const double dx = balls.x[i] - q.x;
  const double dy = balls.y[i] - q.y;
  const double dz = balls.z[i] - q.z;
  const double limit = q.radius + balls.radius[i];
  return dx * dx + dy * dy + dz * dz <= limit * limit;
}

// Bit i is set if ball first + i overlaps `q`; 1 <= count <= 32. For any machine.
inline std::uint32_t portable_overlap_mask(const BallArrays& balls, std::int32_t first,
                                           std::int32_t count, const QueryBall& q) {
  std::uint32_t mask = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    mask |= static_cast<std::uint32_t>(overlaps(balls, first + i, q)) << i;
  }
  return mask;
}

// The same, as fast as this machine can.
inline std::uint32_t overlap_mask(const BallArrays& balls, std::int32_t first, std::int32_t count,
                                  const QueryBall& q) {
#if defined(__SSE2__)
  if (count == 1) return overlaps(balls, first, q) ? 1u : 0u;
  const __m128d qx = _mm_set1_pd(q.x);
  const __m128d qy = _mm_set1_pd(q.y);
  const __m128d qz = _mm_set1_pd(q.z);
  const __m128d qr = _mm_set1_pd(q.radius);
  std::uint32_t mask = 0;
  for (std::int32_t done = 0; done < count; done += 2) {
    // An odd count tests its last but one ball twice, rather than read past the end.
    const std::int32_t lane = done + 2 <= count ? done : count - 2;
    const std::int32_t i = first + lane;
    const __m128d dx = _mm_sub_pd(_mm_loadu_pd(balls.x + i), qx);
    const __m128d dy = _mm_sub_pd(_mm_loadu_pd(balls.y + i), qy);
    const __m128d dz = _mm_sub_pd(_mm_loadu_pd(balls.z + i), qz);
    const __m128d limit = _mm_add_pd(qr, _mm_loadu_pd(balls.radius + i));
    const __m128d d2 =
        _mm_add_pd(_mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy)), _mm_mul_pd(dz, dz));
    const int bits = _mm_movemask_pd(_mm_cmple_pd(d2, _mm_mul_pd(limit, limit)));
    mask |= static_cast<std::uint32_t>(bits) << lane;
  }
  return mask;
#else
  return portable_overlap_mask(balls, first, count, q);
#endif
}

// gaps[i] = distance of the centres minus both radii (negative where they overlap).
inline void ball_gaps(const BallArrays& balls, std::int32_t first, std::int32_t count,
                      const QueryBall& q, double* gaps) {
  for (std::int32_t i = 0; i < count; ++i) {
    const double dx = balls.x[first + i] - q.x;
    const double dy = balls.y[first + i] - q.y;
    const double dz = balls.z[first + i] - q.z;
    gaps[i] = std::sqrt(dx * dx + dy * dy + dz * dz) - (q.radius + balls.radius[first + i]);
  }
}

}  // namespace spherule::internal
