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
  // Calls add(surface, crossing) for each surface, of a line that crosses the triangle as crossing
  // says: 1 from behind, -1 from the front.
  template <typename Add>
  void for_each_surface(int crossing, const Add& add) const {
    if (shell >= 0) add(shell, crossing);
    if (patch >= 0) add(patch, crossing * turn);
    if (front >= 0) add(front, crossing);
    if (back >= 0) add(back, -crossing);
  }
};

// The closed surfaces of a mesh: sets of turned triangles in which every edge is passed as often in
// one direction as in the other.
//
// A shell is a set of triangles connected by shared edges, each as it is turned, and once where all
// are repeated. Most meshes need no more. But triangles with the same corners turned both ways, as
// in a double-sided drawing, balance each other whatever the others are, and say nothing; parts
// that share an edge may take each other's inside away; and a wall between two rooms ends at edges
// that nothing balances. So of a shell where triangles are turned both ways, where more than two
// meet at an edge, or which is not closed, more is judged. Of triangles with the same corners only
// one is taken; then
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
};

// Of triangles with numbered corners and where these lie. Those with equal corners have no role.
MeshShells find_shells(const std::vector<std::array<int, 3>>& triangles,
                       std::span<const Eigen::Vector3d> vertices);
// Of a mesh whose equal vertices are one (weld.h).
MeshShells find_shells(const TriangleMesh& welded);

// The outermost side of the closed surfaces that are connected by shared edges, whichever way their
// triangles are turned.
struct OuterSides {
  // Of every triangle: 1 if it faces outwards as it is turned, -1 if the other way round; 0 if it
  // is no part of the outermost side (a wall between two rooms, a repeated or an open one).
  std::vector<int> turns;
  std::vector<std::int32_t> parts;  // of every closed surface: which of the connected parts
  std::vector<double> volumes;      // that each part encloses, where it does not intersect itself
};
OuterSides outer_sides(const TriangleMesh& welded, const std::vector<TriangleRole>& roles);

// What the closed surfaces of a mesh M (MeshShells, below) prove to be inside. Vertices count as
// one if they are equal bit for bit.
//
// The winding number of a closed surface is a whole number that is the same for all points of a
// component of space without M, and zero for the unbounded one. So a point with another number for
// any of them is in |M|, whatever others count there: also in a sealed hollow, whose inner shell
// takes away what the outer one gives. It is counted along a ray: each triangle crossed from behind
// adds one, each from the front takes one away.
class ClosedShells {
 public:
  // `distance`, of the same mesh, has to outlive the shells.
  ClosedShells(const TriangleMesh& mesh, const MeshDistance& distance);

  // Whether the winding number of a closed surface says that the point, which is not on the
  // surface, is in |M|. Never true of a point outside, but not of all points of |M|: false in
  // hollows that no single surface seals, as where parts only intersect each other. Triangles that
  // are there several times, or turned either way, change nothing.
  bool contain(const Eigen::Vector3d& point) const { return !around(point).empty(); }

  // The closed surfaces, sorted, whose winding number is not zero about a point that is on none.
  std::vector<std::int32_t> around(const Eigen::Vector3d& point) const;

  // Whether every triangle that is not reduced to a segment is of a closed surface.
  bool is_mesh_closed() const { return is_mesh_closed_; }
  // Of every triangle.
  const std::vector<TriangleRole>& roles() const { return roles_; }

 private:
  // Nothing if rounding leaves open whether a ray in this direction crosses some triangle.
  std::optional<std::vector<std::int32_t>> count_along(const Eigen::Vector3d& point,
                                                       const Eigen::Vector3d& direction) const;
  // Of all triangles, by their solid angles: linear in their number.
  std::vector<std::int32_t> sum_of_angles(const Eigen::Vector3d& point) const;

  const MeshDistance& distance_;
  std::vector<TriangleRole> roles_;
  std::size_t surface_count_ = 0;
  bool is_mesh_closed_ = false;
};

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
