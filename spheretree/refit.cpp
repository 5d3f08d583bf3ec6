// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/refit.h"

#include "spheretree/check.h"
#include "spheretree/error.h"
#include "spheretree/internal/node_spheres.h"
#include "spheretree/moved_from.h"
#include "spheretree/rounding_mode.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace spherule {

SphereTree refit(SphereTree tree, std::span<const Sphere> moved) {
  require_rounding_to_nearest();
  internal::require_content(tree.node_count() > 0, "SphereTree");
  SphereTreeData& data = tree.data_;
  if (moved.size() != data.spheres.size()) {
    throw Error("sphere tree", std::to_string(moved.size()) + " moved spheres for a tree over " +
                                   std::to_string(data.spheres.size()));
  }
  internal::require_usable(moved);
  data.spheres.assign(moved.begin(), moved.end());
  std::vector<bool> changed(tree.node_count());
  const auto set_sphere = [&](std::size_t node, const Sphere& sphere) {
    changed[node] = !internal::same_bits(sphere, tree.sphere(node));
    if (changed[node]) internal::set_sphere(data, node, sphere);
  };
  // From the last node to the first, so that the children come before the parent.
  for (std::size_t node = tree.node_count(); node-- > 0;) {
    if (tree.is_leaf(node)) {
      set_sphere(node, moved[static_cast<std::size_t>(tree.sphere_index(node))]);
      continue;
    }
    const auto first = changed.begin() + tree.first_child(node);
    if (std::any_of(first, first + tree.child_count(node), std::identity())) {
      set_sphere(node, internal::sphere_around_children(data, node));
    }
  }
  internal::check_root(data);
  tree.measure();
  assert(check(tree).valid);
  return tree;
}

}  // namespace spherule
