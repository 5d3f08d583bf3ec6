// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <Eigen/Core>

#include <span>
#include <string>

// Meshes that a file shows under transforms.

namespace spherule::internal {

struct Affine {
  Eigen::Matrix3d linear;
  Eigen::Vector3d offset;
};

// Moves the mesh by the last transform of the chain, then by the one before, up to the first, and
// sets its `vertex_error`. The coordinates are off by at most `coordinate_error` of the largest,
// and the entries of a transform by at most `entry_error` of its norms.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error);

// Adds the triangles of the part to the mesh.
void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject);

}  // namespace spherule::internal
