// SPDX-License-Identifier: BSD-3-Clause
#include "collide/search/culling_spheres.h"

#include "spheretree/enclosing_sphere.h"

#include <cstdint>
#include <span>

namespace spherule::internal {
namespace {

// Around more spheres than these, the sphere of the tree is good enough.
constexpr std::size_t kManySpheres = 4096;

}  // namespace

CullingSpheres::CullingSpheres(const SphereTree& tree) : spheres_(tree.node_count()) {
  std::vector<Sphere> leaves;
  visit(tree, 0, leaves);
}

// As deep as the tree: 3 log2 n + 9 at most for those of build_tree(). `leaves` are those visited
// so far.
void CullingSpheres::visit(const SphereTree& tree, std::size_t node, std::vector<Sphere>& leaves) {
  spheres_[node] = tree.sphere(node);
  if (tree.is_leaf(node)) {
    leaves.push_back(spheres_[node]);
    return;
  }
  const std::size_t first = leaves.size();
  for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
    visit(tree, static_cast<std::size_t>(tree.first_child(node) + i), leaves);
  }
  if (leaves.size() - first > kManySpheres) return;
  const Sphere around = enclosing_sphere(std::span<const Sphere>(leaves).subspan(first));
  if (around.radius < spheres_[node].radius) spheres_[node] = around;
}

}  // namespace spherule::internal
