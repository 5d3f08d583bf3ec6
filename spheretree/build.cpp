// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_nodes.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// A tree over n spheres has at most 2 n - 1 nodes, which 32-bit indices must name.
constexpr std::size_t kMaxSpheres = std::size_t{1} << 30U;

// Lays out the wide nodes breadth-first. Spheres of inner nodes are left to fit_spheres().
SphereTreeData lay_out(std::span<const internal::BinaryNode> nodes, std::span<const Sphere> spheres,
                       int branching) {
  SphereTreeData data;
  data.spheres.assign(spheres.begin(), spheres.end());
  const internal::WideNodes wide(nodes, branching);
  std::vector<std::int32_t> sources = {0};
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const internal::BinaryNode& node = nodes[static_cast<std::size_t>(sources[i])];
    if (node.is_leaf()) {
      data.first_child.push_back(node.leaf_sphere);
      data.child_count.push_back(0);
      continue;
    }
    const std::vector<std::int32_t> children = wide.children(sources[i]);
    data.first_child.push_back(static_cast<std::int32_t>(sources.size()));
    data.child_count.push_back(static_cast<std::int32_t>(children.size()));
    sources.insert(sources.end(), children.begin(), children.end());
  }
  return data;
}

// From the last node to the first, so that the children's spheres are there before the parent's.
void fit_spheres(SphereTreeData& data) {
  const std::size_t count = data.child_count.size();
  for (auto* array : {&data.x, &data.y, &data.z, &data.radius}) array->resize(count);
  for (std::size_t node = count; node-- > 0;) {
    internal::set_sphere(data, node,
                         data.child_count[node] == 0
                             ? data.spheres[static_cast<std::size_t>(data.first_child[node])]
                             : internal::sphere_around_children(data, node));
  }
}

void check_input(std::span<const Sphere> spheres, const BuildOptions& options) {
  if (options.branching < 2 || options.branching > SphereTree::kMaxBranching) {
    throw Error("branching", std::to_string(options.branching) + " is not between 2 and " +
                                 std::to_string(SphereTree::kMaxBranching));
  }
  if (spheres.empty()) throw Error("sphere tree", "there is no sphere");
  if (spheres.size() > kMaxSpheres) {
    throw Error("sphere tree", std::to_string(spheres.size()) + " spheres are too many");
  }
  internal::require_usable(spheres);
}

}  // namespace

SphereTree build_tree(std::span<const Sphere> spheres, const BuildOptions& options) {
  require_rounding_to_nearest();
  check_input(spheres, options);
  SphereTreeData data = lay_out(internal::binary_tree(spheres), spheres, options.branching);
  fit_spheres(data);
  internal::check_root(data);
  return SphereTree(std::move(data));
}

SphereTree refit(SphereTree tree, std::span<const Sphere> moved) {
  require_rounding_to_nearest();
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
