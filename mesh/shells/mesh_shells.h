// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
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

}  // namespace spherule::internal
