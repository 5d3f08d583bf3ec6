// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/placed_part.h"

#include "mesh/geometry/vertex_rounding.h"
#include "mesh/io/internal/mesh_readers.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace spherule::internal {

// With a point p of size s, off by e, and a matrix (A, t), off by d relative to its norms, A p + t
// has a size of at most |A| s + |t| and is off by at most |A| e + d (|A| (s + e) + |t|); 2^-50 of
// the size covers the roundings of the product and of these bounds.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error) {
  double size = rounding_distance(largest_coordinate(part), 1.0);
  double error = coordinate_error * size;
  for (std::size_t i = chain.size(); i-- > 0;) {
    const Affine& affine = chain[i];
    const double gain = affine.linear.operatorNorm() * (1.0 + 0x1p-40);
    const double inflated = gain * (size + error) + affine.offset.norm();
    error = gain * error + (entry_error + 0x1p-50) * inflated;
    size = inflated;
    for (Eigen::Vector3d& v : part.vertices) v = affine.linear * v + affine.offset;
  }
  part.vertex_error = error * (1.0 + 0x1p-40);
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject) {
  const auto first = static_cast<std::int64_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Eigen::Vector3i& t : part.triangles) {
    const std::array<std::int64_t, 3> corners{first + t[0], first + t[1], first + t[2]};
    add_polygon(mesh, corners, mesh.vertices.size(), subject);
  }
  mesh.vertex_error = std::max(mesh.vertex_error, part.vertex_error);
}

}  // namespace spherule::internal
