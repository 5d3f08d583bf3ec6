// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

namespace spherule::internal {

// Space in cubes, to keep one thing in each. Plain double: this serves searches, never a proof.
using Cube = std::array<double, 3>;

inline Cube cube_of(const Eigen::Vector3d& point, double edge) {
  const Eigen::Vector3d cube = (point / edge).array().floor();
  return {cube.x(), cube.y(), cube.z()};
}

}  // namespace spherule::internal
