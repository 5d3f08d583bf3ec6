// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/coarse_cover.h"

#include <cstdint>
#include <queue>
#include <utility>

namespace spherule {

std::vector<Sphere> coarse_cover(const SphereTree& tree, std::size_t count) {
  std::priority_queue<std::pair<double, std::size_t>> nodes;
  nodes.push({tree.ball(0).radius, 0});
  std::vector<Sphere> balls;
  while (!nodes.empty()) {
    const std::size_t node = nodes.top().second;
    nodes.pop();
    const auto children = static_cast<std::size_t>(tree.child_count(node));
    if (tree.is_leaf(node) || balls.size() + nodes.size() + children > count) {
      balls.push_back(tree.ball(node));
      continue;
    }
    for (std::size_t i = 0; i < children; ++i) {
      const std::size_t child = static_cast<std::size_t>(tree.first_child(node)) + i;
      nodes.push({tree.ball(child).radius, child});
    }
  }
  return balls;
}

}  // namespace spherule
