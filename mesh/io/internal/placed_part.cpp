// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/placed_part.h"

#include "mesh/geometry/vertex_rounding.h"
#include "mesh/io/internal/mesh_readers.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace spherule::internal {

// With a point p of size s, off by e, and a matrix (A, t), off by d relative to its norms, A p + t
// has a size of at most |A| s + |t| and is off by at most |A| e + d (|A| (s + e) + |t|); 2^-50 of
// the size covers the roundings of the product and of these bounds.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error) {
  double size = rounding_distance(largest_coordinate(part), 1.0);
  double error = part.vertex_error + coordinate_error * size;
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

SkinnedPart::SkinnedPart(const TriangleMesh& rest, double entry_error)
    : rest_(rest),
      entry_error_(entry_error),
      sum_(rest.vertices.size(), Eigen::Vector3d::Zero()),
      error_(rest.vertices.size(), 0.0) {}

// The weight errs by a decimal's rounding, and so does the product; the additions err by one
// rounding each of what is summed so far, which later terms are charged for with the first ones: of
// n terms no product passes through more than n. 2^-46 holds 64 of them.
void SkinnedPart::add(std::span<const Affine> chain, std::span<const JointWeight> weights) {
  TriangleMesh moved;
  moved.vertices.reserve(weights.size());
  for (const JointWeight& part : weights) moved.vertices.push_back(rest_.vertices[part.vertex]);
  moved.vertex_error = rest_.vertex_error;
  place(moved, chain, 0.0, entry_error_);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto [vertex, weight] = weights[i];
    const Eigen::Vector3d& to = moved.vertices[i];
    sum_[vertex] += weight * to;
    error_[vertex] += weight * (moved.vertex_error + 0x1p-46 * to.norm()) * (1.0 + 0x1p-40);
  }
}

TriangleMesh SkinnedPart::take() {
  TriangleMesh result;
  result.vertices = std::move(sum_);
  result.triangles = rest_.triangles;
  for (const double error : error_) {
    result.vertex_error = std::max(result.vertex_error, error * (1.0 + 0x1p-40));
  }
  return result;
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
