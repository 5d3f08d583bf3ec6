// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace spherule::internal {

// Solid angle under which the triangle of the corners a, b, c is seen from the origin, positive if
// they turn to the right as seen from there (Van Oosterom and Strackee 1983). Plain double.
inline double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

}  // namespace spherule::internal
