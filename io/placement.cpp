// SPDX-License-Identifier: BSD-3-Clause
#include "io/placement.h"

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/vertex_rounding.h"
#include "geometry/weld.h"
#include "io/polygon_triangles.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace spherule::internal {

void SceneBudget::take(const TriangleMesh& mesh) {
  shown_ += mesh.vertices.size() + mesh.triangles.size();
  if (shown_ > std::size_t{1} << 25) {
    throw Error(subject_, "shows more than 2^25 vertices and triangles");
  }
}

void SceneBudget::take_moves(std::size_t vertices, std::size_t transforms) {
  moved_ += (vertices + 1) * transforms;
  if (moved_ > std::size_t{1} << 29) {
    throw Error(subject_, "applies transforms to vertices more than 2^29 times");
  }
}

void SceneBudget::check_depth(std::size_t transforms) const {
  if (transforms > 512) throw Error(subject_, "a node under more than 512 transforms");
}

void SceneBudget::take_node() {
  if (++nodes_ > std::size_t{1} << 18) {
    throw Error(subject_, "shows more than 2^18 nodes or objects");
  }
}

void SceneBudget::take_steps(std::size_t count) {
  if (count > steps_) {
    throw Error(subject_, "is too large, or refers to its numbers and elements too many times");
  }
  steps_ -= count;
}

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

void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject) {
  const auto first = static_cast<std::int64_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Eigen::Vector3i& t : part.triangles) {
    const std::array<std::int64_t, 3> corners{first + t[0], first + t[1], first + t[2]};
    add_polygon(mesh, corners, mesh.vertices.size(), subject);
  }
  mesh.vertex_error = std::max(mesh.vertex_error, part.vertex_error);
}

TriangleMesh weld_within(const TriangleMesh& input, double tolerance) {
  TriangleMesh mesh = weld(input);
  if (tolerance == 0.0 || mesh.triangles.empty()) return mesh;
  const std::vector<Eigen::Vector3d> places = mesh.vertices;
  const PointGrid grid(places, tolerance);
  std::vector<char> is_placed(places.size(), 0);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_placed[i] != 0) continue;
    near.clear();
    grid.find(places[i], tolerance, near);
    for (const std::uint32_t k : near) {
      if (is_placed[k] != 0 || distance_upper(places[i], places[k]) > tolerance) continue;
      is_placed[k] = 1;
      mesh.vertices[k] = places[i];
    }
    is_placed[i] = 1;
  }
  mesh.vertex_error = add_up(mesh.vertex_error, tolerance);
  return weld(mesh);
}

}  // namespace spherule::internal
