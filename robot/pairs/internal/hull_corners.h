// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace spherule::internal {

// Some of a set of points, whose convex hull all of them are within `radius` of, proved.
struct HullCorners {
  std::vector<Eigen::Vector3d> corners;
  double radius = 0.0;
};

// Few corners with a radius of little more than the tolerance at most (twice that for each two
// thousand corners that were needed); all points, and 0, where these are few already.
HullCorners hull_corners(std::span<const Eigen::Vector3d> points, double tolerance);

}  // namespace spherule::internal
