// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <string>

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

}  // namespace spherule::internal
