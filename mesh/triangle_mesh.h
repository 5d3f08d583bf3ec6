// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace spherule {

// Triangles as read: a closed set of points M, with no assumption of watertightness, orientation or
// freedom from duplicates. Indices refer to `vertices`; lengths are in the unit of the model.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;

  // Bound on the distance between a vertex as stored here and as written in the file it was read
  // from (a reader that rounds to 32-bit floats, node transforms, scale); of a CAD file, on the
  // distance from its faces to the triangles. Zero for meshes made in memory. The simplifier adds
  // it to the padding, so that its promises hold for what the file describes.
  double vertex_error = 0.0;
};

// Throws Error(subject, ...) unless the mesh can be used at all: at least one triangle, indices in
// range, coordinates finite and at most kMaxCoordinate, vertex_error finite and not negative. Every
// entry point that takes a mesh calls it.
void validate(const TriangleMesh& mesh, const std::string& subject);

}  // namespace spherule
