// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Cells of space: cubes that keep one thing each, and boxes that are halved.

#include "base/rounding.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <utility>

namespace spherule::internal {

// Space in cubes, to keep one thing in each. Plain double: this serves searches, never a proof.
using Cube = std::array<double, 3>;

inline Cube cube_of(const Eigen::Vector3d& point, double edge) {
  const Eigen::Vector3d cube = (point / edge).array().floor();
  return {cube.x(), cube.y(), cube.z()};
}

// Cubes whose edge follows a scale, down to the next power of two, with that power.
using GradedCube = std::pair<int, Cube>;

inline GradedCube graded_cube_of(const Eigen::Vector3d& point, double edge, double scale) {
  const int power = std::ilogb(scale);
  return {power, cube_of(point, std::ldexp(edge, power))};
}

inline double largest_coordinate(const Eigen::AlignedBox3d& box) {
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

// An axis-aligned cell of a subdivision. Half extents carry a margin above the rounding of centres
// (1e-12 of themselves a halving, and a start above the resolution of the coordinates), so that the
// halves of a cell cover it in exact arithmetic.
struct BoxCell {
  Eigen::Vector3d center;
  Eigen::Vector3d half;

  static BoxCell around(const Eigen::AlignedBox3d& box) {
    const double magnitude = largest_coordinate(box);
    return {box.center(), (box.sizes() / 2.0) * (1.0 + 1e-12) +
                              Eigen::Vector3d::Constant(64.0 * kUnitRoundoff * magnitude)};
  }

  // Every point of the cell is within this of the centre.
  double reach() const { return norm_upper(half); }

  // No point of the cell is further from `point`. Each component is rounded once more than in
  // distance_upper(), whose factor has room for 2.5 u more than it needs.
  double furthest(const Eigen::Vector3d& point) const {
    return norm_upper((center - point).cwiseAbs() + half);
  }

  // The axis across which halves() are cut, at the centre; the lower one is the first.
  int longest() const {
    int axis = 0;
    half.maxCoeff(&axis);
    return axis;
  }

  std::array<BoxCell, 2> halves() const {
    const int axis = longest();
    BoxCell low = *this;
    low.half[axis] =
        0.5 * half[axis] * (1.0 + 1e-12) + 2.0 * kUnitRoundoff * std::abs(center[axis]);
    BoxCell high = low;
    low.center[axis] = center[axis] - 0.5 * half[axis];
    high.center[axis] = center[axis] + 0.5 * half[axis];
    return {low, high};
  }
};

}  // namespace spherule::internal
