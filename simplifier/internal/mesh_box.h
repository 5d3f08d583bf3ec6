// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/triangle_mesh.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace spherule::internal {

// Around the vertices that triangles use.
inline Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  }
  return box;
}

}  // namespace spherule::internal
