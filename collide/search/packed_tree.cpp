// SPDX-License-Identifier: BSD-3-Clause
#include "collide/search/packed_tree.h"

#include "base/rounding.h"
#include "geometry/sphere.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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

[[gnu::noinline]] double in_single_precision(double x) {
  return static_cast<double>(static_cast<float>(x));
}

float rounded_up_to_single(double x) {
  const double nearest = in_single_precision(x);
  const auto result = static_cast<float>(nearest);
  return nearest >= x ? result : std::nextafter(result, std::numeric_limits<float>::infinity());
}

namespace {

// Far from everything, with a square that does not overflow.
constexpr float kNowhere = 3e18F;
constexpr double kAbsolute = 0x1p-60;

Sphere packed(const Sphere& sphere, double inflation) {
  const Eigen::Vector3d center(in_single_precision(sphere.center.x()),
                               in_single_precision(sphere.center.y()),
                               in_single_precision(sphere.center.z()));
  const double moved = distance_upper(center, sphere.center);
  const double radius =
      mul_up(add_up(add_up(sphere.radius, moved), inflation), 1.0 + 8.0 * kFloatRoundoff);
  return {center, static_cast<double>(rounded_up_to_single(add_up(radius, kAbsolute)))};
}

PackedNode empty_node() {
  PackedNode node;
  std::fill_n(node.x, PackedNode::kWidth, kNowhere);
  std::fill_n(node.y, PackedNode::kWidth, kNowhere);
  std::fill_n(node.z, PackedNode::kWidth, kNowhere);
  std::fill_n(node.radius, PackedNode::kWidth, 0.0F);
  std::fill_n(node.child, PackedNode::kWidth, -1);
  return node;
}

void set_lane(PackedNode& node, int lane, const Sphere& sphere, std::int32_t child) {
  node.x[lane] = static_cast<float>(sphere.center.x());
  node.y[lane] = static_cast<float>(sphere.center.y());
  node.z[lane] = static_cast<float>(sphere.center.z());
  node.radius[lane] = static_cast<float>(sphere.radius);
  node.child[lane] = child;
}

}  // namespace

PackedTree::PackedTree(const SphereTree& tree, double inflation)
    : PackedTree(tree, CullingSpheres(tree), Pose(), inflation) {}

PackedTree::PackedTree(const SphereTree& tree, const CullingSpheres& culling, const Pose& pose,
                       double inflation) {
  assert(tree.branching() <= PackedNode::kWidth);
  const auto placed = [&](const Sphere& sphere) {
    return Sphere{pose * sphere.center, sphere.radius};
  };
  root_ = packed(placed(culling[0]), inflation);
  depth_ = std::max(1, tree.depth());
  for (const Sphere& sphere : tree.spheres()) {
    const Sphere leaf = packed(placed(sphere), inflation);
    largest_inflation_ = std::max(largest_inflation_, sub_up(leaf.radius, sphere.radius));
    leaves_.push_back({{static_cast<float>(leaf.center.x()), static_cast<float>(leaf.center.y()),
                        static_cast<float>(leaf.center.z())},
                       static_cast<float>(leaf.radius)});
  }
  // Inner nodes in the order of the tree, so that a node's number is the count of those before it.
  std::vector<std::int32_t> number(tree.node_count());
  std::int32_t inner = 0;
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    number[node] = tree.is_leaf(node) ? ~tree.sphere_index(node) : inner++;
  }
  if (inner == 0) {
    nodes_.push_back(empty_node());
    set_lane(nodes_.back(), 0, root_, number[0]);
  }
  nodes_.reserve(static_cast<std::size_t>(inner) + 1);
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    if (tree.is_leaf(node)) continue;
    nodes_.push_back(empty_node());
    for (std::int32_t lane = 0; lane < tree.child_count(node); ++lane) {
      const auto child = static_cast<std::size_t>(tree.first_child(node) + lane);
      set_lane(nodes_.back(), lane, packed(placed(culling[child]), inflation), number[child]);
    }
  }
  nodes_.push_back(empty_node());
  set_lane(nodes_.back(), 0, root_, 0);
}

}  // namespace spherule::internal
