// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/coarse_cover.h"

#include <cstdint>
#include <queue>
#include <utility>

namespace spherule {

std::vector<Sphere> coarse_cover(const SphereTree& tree, std::size_t count) {
  std::priority_queue<std::pair<double, std::size_t>> nodes;
  nodes.push({tree.sphere(0).radius, 0});
  std::vector<Sphere> spheres;
  while (!nodes.empty()) {
    const std::size_t node = nodes.top().second;
    nodes.pop();
    const auto children = static_cast<std::size_t>(tree.child_count(node));
    if (tree.is_leaf(node) || spheres.size() + nodes.size() + children > count) {
      spheres.push_back(tree.sphere(node));
      continue;
    }
    for (std::size_t i = 0; i < children; ++i) {
      const std::size_t child = static_cast<std::size_t>(tree.first_child(node)) + i;
      nodes.push({tree.sphere(child).radius, child});
    }
  }
  return spheres;
}

}  // namespace spherule
