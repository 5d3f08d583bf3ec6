// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

// The formats that are scene graphs: COLLADA and glTF; and what they and 3MF may cost.

namespace spherule::internal {

// Read the scene of the file, whose content is `bytes`: every mesh under the transforms of each
// node that shows it, skins and morph weights as the file states them. What would be shown in
// another way than the format specifies is refused. Numbers are read as doubles; `vertex_error`
// charges their rounding and that of the transforms, some 2^-45 of the coordinates. Throw Error.
//
// COLLADA files come out in metres (their own <unit> applied) with the axes as they stand in the
// file (<up_axis> is ignored, as the tools of ROS do); glTF files in their own numbers.
TriangleMesh read_collada(std::string_view bytes, const std::string& subject);
TriangleMesh read_gltf(std::string_view bytes, const std::filesystem::path& path);

// The size in metres that a COLLADA text states of its unit; 1 where it states none.
double collada_unit(std::string_view text, const std::string& subject);

// What a scene may cost: a small file can show its meshes, and refer to its numbers, any number of
// times.
class SceneBudget {
 public:
  // How many steps are allowed depends on the format.
  SceneBudget(const std::string& subject, std::size_t steps) : subject_(subject), steps_(steps) {}

  // Before a mesh is shown under so many transforms. Throws Error beyond 2^25 vertices and
  // triangles together, and 2^29 vertices times transforms; every mesh counts one vertex more.
  void take(const TriangleMesh& mesh, std::size_t transforms);
  // Throws Error for more than 512 transforms of one node and those above it.
  void check_depth(std::size_t transforms) const;
  // A node of the scene. Throws Error beyond 2^18.
  void take_node();
  // Numbers that are read, elements that are visited: each time anew. Throws Error beyond what is
  // allowed.
  void take_steps(std::size_t count);

 private:
  const std::string& subject_;
  std::size_t steps_;  // that are left
  std::size_t shown_ = 0;
  std::size_t moved_ = 0;
  std::size_t nodes_ = 0;
};

}  // namespace spherule::internal
