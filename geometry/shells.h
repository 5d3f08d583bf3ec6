// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
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

// For which closed surfaces a triangle counts; -1 for none. Shells, patches and cells have numbers
// of one sequence.
struct TriangleRole {
  std::int32_t shell = -1;  // counts as it is turned
  std::int32_t patch = -1;  // counts turned by `turn`
  int turn = 1;
  std::int32_t front = -1;  // the cell before it: counts as it is turned
  std::int32_t back = -1;   // the cell behind it: counts the other way round

  bool counts() const { return shell >= 0 || encloses(); }
  bool encloses() const { return patch >= 0 || front >= 0 || back >= 0; }
};

// The closed surfaces of a mesh: sets of turned triangles in which every edge is passed as often in
// one direction as in the other.
//
// A shell is a set of triangles connected by shared edges, each as it is turned. Most meshes need
// no more. But triangles with the same corners turned both ways, as in a double-sided drawing,
// balance each other whatever the others are, and say nothing; parts that share an edge may take
// each other's inside away; and a wall between two rooms ends at edges that nothing balances. So of
// a shell where triangles are turned both ways, where more than two meet at an edge, or which is
// not closed, more is judged. Of triangles with the same corners only one is taken; then
//   - those that alone share an edge make up a patch and are turned alike. It is closed if every
//     edge is balanced then, and so never if it has a boundary or cannot be turned alike;
//   - the sides of triangles that face each other around an edge, next to each other in the order
//     of the angles, bound one cell. All sides of a cell are a closed surface, because those that
//     face each other balance: whatever the order, which rounding may spoil. Where triangles meet
//     at shared edges only, the cells are the components of space without the mesh, up to shells
//     within shells; a triangle with the same cell on both sides counts for none.
//
// The winding number of a closed surface is zero in the unbounded component of space without the
// mesh, so where one has another number there is no way out.
struct MeshShells {
  std::vector<TriangleRole> roles;  // of every triangle
  // Whether all triangles with three different corners are of a closed surface; of those that
  // are turned both ways, of a patch or cell.
  bool are_closed = true;
  // Whether every edge is passed as often in one direction as in the other: all shells are closed.
  bool are_balanced = true;
};

// Of triangles with numbered corners and where these lie. Those with equal corners have no role.
MeshShells find_shells(const std::vector<std::array<int, 3>>& triangles,
                       std::span<const Eigen::Vector3d> vertices);

// Disjoint sets of which every element is turned like the one that stands for its set (+1) or the
// other way round (-1).
class OrientedDisjointSets {
 public:
  struct Place {
    int root;
    int turn;  // against that of the root
  };

  explicit OrientedDisjointSets(std::size_t count) : up_(count), turn_(count, 1) {
    std::iota(up_.begin(), up_.end(), 0);
  }

  Place find(int v) {
    int turn = 1;
    while (up(v) != v) {
      turn_of(v) *= turn_of(up(v));
      up(v) = up(up(v));
      turn *= turn_of(v);
      v = up(v);
    }
    return {v, turn};
  }
  // Elements of one set already stay turned as they are.
  void join(int a, int b, int turn = 1) {
    const Place of_a = find(a), of_b = find(b);
    if (of_a.root == of_b.root) return;
    up(of_a.root) = of_b.root;
    turn_of(of_a.root) = of_a.turn * turn * of_b.turn;
  }

 private:
  int& up(int v) { return up_[static_cast<std::size_t>(v)]; }
  int& turn_of(int v) { return turn_[static_cast<std::size_t>(v)]; }

  std::vector<int> up_;
  std::vector<int> turn_;  // against that of the element above
};

}  // namespace spherule::internal
