// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/rounding.h"

#include <Eigen/Geometry>

namespace spherule::internal {

// How the ray from the origin along a direction crosses a triangle: out of the side from which its
// corners turn to the left, or into it. Uncertain where rounding may change the answer.
enum class RayCrossing : char { kNone, kFromBehind, kFromFront, kUncertain };

namespace ray_crossing_details {

// Sign of a . (b x c); 0 where rounding may change it. `size` bounds |a| |b| |c|.
//
// Each of the vectors has components with a relative error of at most u (a corner less a point) or
// none (the direction). A product of two of them errs by 3 u of itself, the difference of two by
// 4 u of the sum of their absolute values, and the sum over the components, each times the third
// vector's (2 u more), with two additions, by 8 u of the sum of all absolute values. That sum is at
// most sqrt(2) |a| |b| |c|, and 32 u of `size` holds all of it; 2^-900 what underflows.
inline int sign_of_determinant(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c, double size) {
  const double value = a.dot(b.cross(c));
  const double error = 32.0 * kUnitRoundoff * size + 0x1p-900;
  if (value > error) return 1;
  return value < -error ? -1 : 0;
}

}  // namespace ray_crossing_details

// Of the triangle a, b, c, given relative to the ray's origin with one rounding each; the direction
// has at most length 1.
//
// The direction is d = x a + y b + z c with x = [d, b, c] / [a, b, c] and so on, [ ] a determinant:
// the ray crosses the triangle if all three are positive, and the line does if they have one sign.
inline RayCrossing ray_crossing(const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  using ray_crossing_details::sign_of_determinant;
  const double to_a = norm_upper(a), to_b = norm_upper(b), to_c = norm_upper(c);
  const int x = sign_of_determinant(direction, b, c, to_b * to_c);
  const int y = sign_of_determinant(direction, c, a, to_c * to_a);
  if (x * y < 0) return RayCrossing::kNone;
  const int z = sign_of_determinant(direction, a, b, to_a * to_b);
  if (x * z < 0 || y * z < 0) return RayCrossing::kNone;
  if (x == 0 || y == 0 || z == 0) return RayCrossing::kUncertain;
  const int side = sign_of_determinant(a, b, c, to_a * to_b * to_c);
  if (side == 0) return RayCrossing::kUncertain;
  if (side != x) return RayCrossing::kNone;
  return side > 0 ? RayCrossing::kFromBehind : RayCrossing::kFromFront;
}

}  // namespace spherule::internal
