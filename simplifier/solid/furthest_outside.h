// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/nearest_sphere.h"
#include "spheretree/rounding.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace spherule::internal {

// No point of the cell that is not in the open sphere `excluded` is further from `point` than the
// result (G1), which is never above BoxCell::furthest().
//
// With d and e the vectors to the centre of the cell from `point` and from the centre of the
// sphere, R its radius and m any number that is not negative: for y with |e + y| >= R
//
//   |d + y|^2 <= |d + y|^2 + m (|e + y|^2 - R^2)
//              = |d|^2 + m (|e|^2 - R^2) + 2 (d + m e) . y + (1 + m) |y|^2,
//
// which is largest where each |y_i| is the half extent and has the sign of (d + m e)_i. For
// m = |d| / |e|, d + m e is zero where d and e are opposite: the excess is then, up to terms of
// higher order, at most (1 / |d| + 1 / |e|) |half|^2 / 2.
//
// Rounding: no term passes through more than 12 operations, so that the sum errs by less than 16 u
// times the sum of the sizes of all terms, of which 32 u are added. Squares that underflow lose
// less than (1 + m) 2^-1070 in all. If m > 0, |d| is at least 2^-537, and 32 u of m |e|^2, which is
// about |d| |e|, are more; if m = 0, kUnderflow is more than the root of that. Where subnormal
// numbers are zero, this holds for what rounding.h says of distances: 0 or at least 2^-460.
inline double furthest_outside(const BoxCell& cell, const Eigen::Vector3d& point,
                               const Sphere& excluded) {
  const double anywhere = cell.furthest(point);
  const Eigen::Vector3d d = cell.center - point;
  const Eigen::Vector3d e = cell.center - excluded.center;
  const double length = e.norm();
  if (length < kLeastNorm) return anywhere;
  const double m = d.norm() / length;
  const double squares = d.squaredNorm() + m * e.squaredNorm();
  const double removed = m * excluded.radius * excluded.radius;
  const double around = (1.0 + m) * cell.half.squaredNorm();
  const double slope = 2.0 * (d + m * e).cwiseAbs().dot(cell.half);
  const double sizes =
      squares + removed + around + 2.0 * (d.cwiseAbs() + m * e.cwiseAbs()).dot(cell.half);
  const double squared = (squares - removed) + slope + around + 32.0 * kUnitRoundoff * sizes;
  return std::min(anywhere, std::sqrt(std::max(squared, 0.0)) * kRelativeUp + kUnderflow);
}

}  // namespace spherule::internal
