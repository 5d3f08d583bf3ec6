// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/scene_file.h"
#include "spheretree/error.h"

namespace spherule::internal {

void SceneBudget::take(const TriangleMesh& mesh, std::size_t transforms) {
  shown_ += mesh.vertices.size() + mesh.triangles.size();
  if (shown_ > std::size_t{1} << 25) {
    throw Error(subject_, "shows more than 2^25 vertices and triangles");
  }
  moved_ += (mesh.vertices.size() + 1) * transforms;
  if (moved_ > std::size_t{1} << 29) {
    throw Error(subject_, "moves more than 2^29 vertices by its transforms");
  }
}

void SceneBudget::check_depth(std::size_t transforms) const {
  if (transforms > 512) throw Error(subject_, "a node under more than 512 transforms");
}

void SceneBudget::take_node() {
  if (++nodes_ > std::size_t{1} << 18) throw Error(subject_, "shows more than 2^18 nodes");
}

void SceneBudget::take_steps(std::size_t count) {
  if (count > steps_) throw Error(subject_, "refers to its numbers and elements too many times");
  steps_ -= count;
}

}  // namespace spherule::internal
