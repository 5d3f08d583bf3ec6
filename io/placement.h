// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

// Meshes that a file shows under transforms, and how they become one.

namespace spherule::internal {

// Limits of the work that a scene can cause: a small file can show its meshes, and refer to its
// numbers, any number of times. The limits are in docs/security.md.
class SceneBudget {
 public:
  // How many steps are allowed depends on the format.
  SceneBudget(const std::string& subject, std::size_t steps) : subject_(subject), steps_(steps) {}

  // Before a mesh is shown. Throws Error beyond 2^25 vertices and triangles together.
  void take(const TriangleMesh& mesh);
  // Before so many transforms are applied to vertices. Throws Error beyond 2^29, vertices times
  // transforms; a chain of transforms counts as one vertex itself.
  void take_moves(std::size_t vertices, std::size_t transforms);
  // Throws Error for more than 512 transforms of one node and those above it.
  void check_depth(std::size_t transforms) const;
  // A node, or an object of 3MF. Throws Error beyond 2^18.
  void take_node();
  // Numbers read and elements visited, each time that they are. Throws Error when more steps are
  // taken than the constructor allows.
  void take_steps(std::size_t count);

 private:
  const std::string& subject_;
  std::size_t steps_;  // that are left
  std::size_t shown_ = 0;
  std::size_t moved_ = 0;
  std::size_t nodes_ = 0;
};

// Not to be changed once it is made, or `gain` is wrong.
struct Affine {
  Affine() = default;
  Affine(const Eigen::Matrix3d& of_linear, const Eigen::Vector3d& of_offset);

  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  // An upper bound of the spectral norm of `linear`, found once, as every instance needs it.
  double gain = 1.0;
};

// The transform of a matrix for column vectors; nothing if it is not affine or not finite.
std::optional<Affine> affine_from(const Eigen::Matrix4d& matrix);

// Moves the mesh by the last transform of the chain, then by the one before, up to the first, and
// adds to its `vertex_error`. The coordinates are off by at most that and `coordinate_error` of the
// largest, and the entries of a transform by at most `entry_error` of its norms. Where the chain
// mirrors, the triangles are flipped (glTF 2.0, 3.7.4), so that what is closed keeps its inside.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error);

// Adds the triangles of the part to the mesh.
void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject);

// The mesh with vertices that are no further apart than `tolerance` made one, so that cracks which
// rounding has left are shut. In the order of the vertices, each that no other stands for yet
// stands for itself and for those near to it that follow; so none moves by more than the tolerance,
// which is added to `vertex_error`, and no point of a triangle does. Triangles that lose their area
// stay.
TriangleMesh weld_within(const TriangleMesh& mesh, double tolerance);

}  // namespace spherule::internal
