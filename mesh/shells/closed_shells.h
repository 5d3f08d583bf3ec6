// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace spherule::internal {

// The closed shells of a mesh M, and what they prove to be inside. A shell is a set of triangles
// connected by shared edges (vertices count as one if they are equal bit for bit) in which every
// edge is used as often in one direction as in the other. Triangles of parts that are not closed
// are left out.
//
// The winding number of a shell is a whole number that is the same for all points of a component of
// space without M, and zero for the unbounded one. So a point with another number for any shell is
// in |M|, whatever other shells count there: also in a sealed hollow, whose inner shell takes away
// what the outer one gives. It is counted along a ray: each triangle crossed from behind adds one,
// each from the front takes one away.
class ClosedShells {
 public:
  // `distance`, of the same mesh, has to outlive the shells.
  ClosedShells(const TriangleMesh& mesh, const MeshDistance& distance);

  // Whether the winding number of a shell says that the point, which is not on the surface, is in
  // |M|. Never true of a point outside, but not of all points of |M|: false in hollows that no
  // single shell seals, in shells that are double-sided, not turned alike, or have a wall between
  // rooms, and where parts that share an edge are turned against each other. So it may witness that
  // a point has to be covered, and must not prove that one need not be: certify() has the flood for
  // that, which knows no orientation.
  bool contain(const Eigen::Vector3d& point) const;

  // The sum of the winding numbers of all shells about a point that is not on the surface: of the
  // mesh, if that is closed.
  int winding_number(const Eigen::Vector3d& point) const;

  // Whether no edge of the mesh is used more often in one direction than in the other.
  bool is_mesh_closed() const { return is_mesh_closed_; }

 private:
  // The winding numbers of shells, sorted; zero for those that are not named.
  using Windings = std::vector<std::pair<std::int32_t, int>>;

  Windings windings(const Eigen::Vector3d& point) const;
  // Nothing if rounding leaves open whether a ray in this direction crosses some triangle.
  std::optional<Windings> count_along(const Eigen::Vector3d& point,
                                      const Eigen::Vector3d& direction) const;
  // Of all triangles, by their solid angles: linear in their number.
  Windings sum_of_angles(const Eigen::Vector3d& point) const;

  const MeshDistance& distance_;
  std::vector<std::int32_t> shell_of_;  // of each triangle; kOpen without one
  std::size_t shell_count_ = 0;
  bool is_mesh_closed_ = false;
};

}  // namespace spherule::internal
