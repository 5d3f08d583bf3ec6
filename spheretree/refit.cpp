// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/refit.h"

#include "spheretree/error.h"
#include "spheretree/internal/node_balls.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

SphereTree refit(const SphereTree& tree, std::span<const Sphere> moved) {
  if (moved.size() != tree.spheres().size()) {
    throw Error("sphere tree", std::to_string(moved.size()) + " moved spheres for a tree over " +
                                   std::to_string(tree.spheres().size()));
  }
  internal::check_usable(moved);
  SphereTreeData data = tree.data();
  data.spheres.assign(moved.begin(), moved.end());
  std::vector<bool> changed(tree.node_count(), false);
  // From the last node to the first, so that the children come before the parent.
  for (std::size_t node = tree.node_count(); node-- > 0;) {
    if (tree.is_leaf(node)) {
      const Sphere& sphere = moved[static_cast<std::size_t>(tree.sphere_index(node))];
      changed[node] = !internal::same_bits(sphere, tree.ball(node));
      internal::set_ball(data, node, sphere);
      continue;
    }
    const auto first = changed.begin() + tree.first_child(node);
    if (!std::any_of(first, first + tree.child_count(node), std::identity())) continue;
    const Sphere ball = internal::ball_around_children(data, node);
    changed[node] = !internal::same_bits(ball, tree.ball(node));
    internal::set_ball(data, node, ball);
  }
  return internal::tree_of(std::move(data));
}

}  // namespace spherule
