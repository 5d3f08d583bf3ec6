// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <Eigen/Geometry>

#include <array>
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
// what the outer one gives.
class ClosedShells {
 public:
  explicit ClosedShells(const TriangleMesh& mesh);

  // Whether the winding number of a shell says that the point, which is not on the surface, is in
  // |M|. Never true of a point outside, but not of all points of |M|: false in hollows that no
  // single shell seals, in shells that are double-sided, not turned alike, or have a wall between
  // rooms, and where parts that share an edge are turned against each other. So it may witness that
  // a point has to be covered, and must not prove that one need not be: certify() has the flood for
  // that, which knows no orientation.
  bool contain(const Eigen::Vector3d& point) const;

 private:
  struct Shell {
    std::vector<std::array<Eigen::Vector3d, 3>> triangles;
    Eigen::AlignedBox3d box;
  };
  std::vector<Shell> shells_;
};

}  // namespace spherule::internal
