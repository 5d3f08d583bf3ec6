// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// For which closed surfaces a triangle counts; -1 for none. Shells and patches have numbers of one
// sequence.
struct TriangleRole {
  std::int32_t shell = -1;  // counts as it is turned
  std::int32_t patch = -1;  // counts turned by `turn`
  int turn = 1;

  bool counts() const { return shell >= 0 || patch >= 0; }
};

// The closed surfaces of a mesh.
//
// A shell is a set of triangles connected by shared edges. It is closed if every edge is passed as
// often in one direction as in the other. Where triangles with the same corners are turned both
// ways, as in a double-sided drawing, they balance each other whatever the others are, and say
// nothing. So the patches of such a shell are judged as well: of triangles with the same corners
// only one is taken; those that alone share an edge make up a patch and are turned alike; it is
// closed if every edge is balanced then, and so never if it has a boundary or cannot be turned
// alike.
//
// The winding number of a closed shell or patch is zero in the unbounded component of space without
// the mesh, so where one has another number there is no way out.
struct MeshShells {
  std::vector<TriangleRole> roles;  // of every triangle
  // Whether all shells are closed, those with triangles turned both ways by their patches.
  bool are_closed = true;
};

// Of triangles with numbered corners. Those with equal corners have no role.
MeshShells find_shells(const std::vector<std::array<int, 3>>& triangles);

}  // namespace spherule::internal
