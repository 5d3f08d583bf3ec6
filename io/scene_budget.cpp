// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene_budget.h"

#include "base/error.h"

namespace spherule::internal {

void SceneBudget::take(const TriangleMesh& mesh) {
  shown_ += mesh.vertices.size() + mesh.triangles.size();
  if (shown_ > std::size_t{1} << 25) {
    throw Error(subject_, "shows more than 2^25 vertices and triangles");
  }
}

void SceneBudget::take_moves(std::size_t vertices, std::size_t transforms) {
  moved_ += (vertices + 1) * transforms;
  if (moved_ > std::size_t{1} << 29) {
    throw Error(subject_, "applies transforms to vertices more than 2^29 times");
  }
}

void SceneBudget::check_depth(std::size_t transforms) const {
  if (transforms > 512) throw Error(subject_, "a node under more than 512 transforms");
}

void SceneBudget::take_node() {
  if (++nodes_ > std::size_t{1} << 18) {
    throw Error(subject_, "shows more than 2^18 nodes or objects");
  }
}

void SceneBudget::take_steps(std::size_t count) {
  if (count > steps_) {
    throw Error(subject_, "is too large, or refers to its numbers and elements too many times");
  }
  steps_ -= count;
}

}  // namespace spherule::internal
