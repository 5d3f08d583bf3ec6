// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace spherule::internal {

inline double area_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  return 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
}

// A point of the triangle: number k of a sequence that fills it evenly from any start on. This is
// Roberts's R2 sequence, of low discrepancy in the unit square, whose upper half is turned onto the
// lower one.
inline Eigen::Vector3d evenly_in(const std::array<Eigen::Vector3d, 3>& triangle, double k,
                                 const Eigen::Vector2d& start = Eigen::Vector2d::Zero()) {
  constexpr double kStepU = 0.7548776662466927;  // 1/g and 1/g^2, g^3 = g + 1
  constexpr double kStepV = 0.5698402909980532;
  double u = start.x() + kStepU * k;
  double v = start.y() + kStepV * k;
  u -= std::floor(u);
  v -= std::floor(v);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]);
}

}  // namespace spherule::internal
