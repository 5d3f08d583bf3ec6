// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// The spheres of a tree's nodes, as a search culls with them: for each node the tree's own, or the
// smallest around the leaves below it where that is smaller (it need not enclose the nodes between,
// since nothing but leaves decides).
class CullingSpheres {
 public:
  explicit CullingSpheres(const SphereTree& tree);

  const Sphere& operator[](std::size_t node) const { return spheres_[node]; }

 private:
  void visit(const SphereTree& tree, std::size_t node, std::vector<Sphere>& leaves);

  std::vector<Sphere> spheres_;
};

}  // namespace spherule::internal
