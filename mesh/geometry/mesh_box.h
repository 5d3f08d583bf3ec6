// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <span>

namespace spherule::internal {

// Around the vertices that triangles use.
inline Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  }
  return box;
}

// Around the spheres, up to rounding.
inline Eigen::AlignedBox3d box_of(std::span<const Sphere> spheres) {
  Eigen::AlignedBox3d box;
  for (const Sphere& s : spheres) {
    box.extend(Eigen::Vector3d(s.center - Eigen::Vector3d::Constant(s.radius)));
    box.extend(Eigen::Vector3d(s.center + Eigen::Vector3d::Constant(s.radius)));
  }
  return box;
}

}  // namespace spherule::internal
