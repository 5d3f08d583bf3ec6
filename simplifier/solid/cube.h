// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

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

}  // namespace spherule::internal
