// SPDX-License-Identifier: BSD-3-Clause
#include "io/placed_part.h"

#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace spherule::internal {

Affine::Affine(const Eigen::Matrix3d& of_linear, const Eigen::Vector3d& of_offset)
    : linear(of_linear), offset(of_offset), gain(linear.operatorNorm() * (1.0 + 0x1p-40)) {}

std::optional<Affine> affine_from(const Eigen::Matrix4d& matrix) {
  const bool is_affine = matrix.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  if (!is_affine || !matrix.allFinite()) return std::nullopt;
  return Affine{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

// With a point p of size s, off by e, and a matrix (A, t), off by d relative to its norms, A p + t
// has a size of at most |A| s + |t| and is off by at most |A| e + d (|A| (s + e) + |t|); 2^-50 of
// the size covers the roundings of the product and of these bounds.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error) {
  double size = rounding_distance(largest_coordinate(part), 1.0);
  double error = part.vertex_error + coordinate_error * size;
  bool is_mirrored = false;
  for (std::size_t i = chain.size(); i-- > 0;) {
    const Affine& affine = chain[i];
    const double inflated = affine.gain * (size + error) + affine.offset.norm();
    error = affine.gain * error + (entry_error + 0x1p-50) * inflated;
    size = inflated;
    for (Eigen::Vector3d& v : part.vertices) v = affine.linear * v + affine.offset;
    is_mirrored = is_mirrored != (affine.linear.determinant() < 0.0);
  }
  if (is_mirrored) {
    for (Eigen::Vector3i& t : part.triangles) std::swap(t[1], t[2]);
  }
  part.vertex_error = error * (1.0 + 0x1p-40);
}

SkinnedPart::SkinnedPart(const TriangleMesh& rest, double entry_error)
    : rest_(rest), entry_error_(entry_error), sums_(rest.vertices.size()) {}

void SkinnedPart::add(std::span<const Affine> chain, std::span<const JointWeight> weights) {
  TriangleMesh moved;
  moved.vertices.reserve(weights.size());
  for (const JointWeight& part : weights) moved.vertices.push_back(rest_.vertices[part.vertex]);
  moved.vertex_error = rest_.vertex_error;
  place(moved, chain, 0.0, entry_error_);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Eigen::Vector3d& to = moved.vertices[i];
    Sum& sum = sums_[weights[i].vertex];
    sum.position += weights[i].weight * to;
    sum.size += weights[i].weight * to.norm();
    sum.error += weights[i].weight * moved.vertex_error;
    ++sum.terms;
  }
}

// Of n terms each errs by the rounding of its weight, a decimal, and of the product, and passes
// through at most n additions: together less than (n + 3) u of the sizes of all, u = 2^-53. Twice
// that holds the rounding of these sums of sizes and errors, too.
TriangleMesh SkinnedPart::take() {
  TriangleMesh result;
  result.triangles = rest_.triangles;
  result.vertices.reserve(sums_.size());
  for (const Sum& sum : sums_) {
    const double terms = static_cast<double>(sum.terms) + 3.0;
    const double upward = 1.0 + terms * 0x1p-52;
    result.vertices.push_back(sum.position);
    result.vertex_error =
        std::max(result.vertex_error, (sum.error + terms * 0x1p-52 * sum.size) * upward);
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
