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

// No point of the cell that is not in the open sphere `left_out` is further from `point`; never
// above BoxCell::furthest(). Where the cell lies between `point` and the centre of the sphere, the
// bound exceeds the greatest distance by an amount of the order of the square of the cell's size.
//
// With d and e the vectors to the centre of the cell from `point` and from the centre of the
// sphere, R its radius and m any number that is not negative: for y with |e + y| >= R
//
//   |d + y|^2 <= |d + y|^2 + m (|e + y|^2 - R^2)
//              = |d|^2 + m (|e|^2 - R^2) + 2 (d + m e) . y + (1 + m) |y|^2,
//
// which is largest where each |y_i| is the half extent and has the sign of (d + m e)_i. For
// m = |d| / |e|, d + m e is zero where d and e are opposite.
//
// Rounding: no term passes through more than 10 operations (d and e: one, squared norms: three
// more), so the sum errs by less than 16 u times the sum of the sizes of all terms, of which 32 u
// are added. That covers squares that underflow too, as |e|^2 is far above 2^-1022.
inline double furthest_outside(const BoxCell& cell, const Eigen::Vector3d& point,
                               const Sphere& left_out) {
  const double anywhere = cell.furthest(point);
  const Eigen::Vector3d d = cell.center - point;
  const Eigen::Vector3d e = cell.center - left_out.center;
  const double length = e.norm();
  if (length < kLeastNorm) return anywhere;
  const double m = d.norm() / length;
  const double squares = d.squaredNorm() + m * e.squaredNorm();
  const double room = m * left_out.radius * left_out.radius;
  const double around = (1.0 + m) * cell.half.squaredNorm();
  const double slope = 2.0 * (d + m * e).cwiseAbs().dot(cell.half);
  const double sizes =
      squares + room + around + 2.0 * (d.cwiseAbs() + m * e.cwiseAbs()).dot(cell.half);
  const double squared = (squares - room) + slope + around + 32.0 * kUnitRoundoff * sizes;
  return std::min(anywhere, std::sqrt(std::max(0.0, squared)) * kRelativeUp + kUnderflow);
}

}  // namespace spherule::internal
