// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <span>

namespace spherule::internal {

// The index of the first of the points that are least along an axis; 0 without points.
std::size_t least_along(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& axis);

// A direction along which two convex hulls of points are far apart, and by how much, up to
// rounding: nothing is proved here, whoever uses the direction proves what it needs.
struct HullDirection {
  Eigen::Vector3d direction =
      Eigen::Vector3d::UnitX();  // of unit length, from the second to the first
  double gap = 0.0;              // least along it of the first, minus the most of the second
  // Two points of the hulls are so far apart: the hulls are no farther.
  double distance = std::numeric_limits<double>::infinity();
};

// Gilbert, Johnson and Keerthi's iteration for the nearest points of the hulls, started along
// `start`, until they are known to be no farther apart than `enough`. Points of the second hull are
// given in the frame of the first.
HullDirection hull_direction(std::span<const Eigen::Vector3d> first,
                             std::span<const Eigen::Vector3d> second,
                             const Eigen::Matrix3d& first_from_second,
                             const Eigen::Vector3d& origin_of_second, const Eigen::Vector3d& start,
                             double enough = 0.0);

}  // namespace spherule::internal
