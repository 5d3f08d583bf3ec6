// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/patch_trees.h"

#include "spheretree/rounding.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace spherule::internal {
namespace {

using Box = Eigen::AlignedBox3d;

PatchNode node_of(const Box& box) {
  PatchNode node{};
  for (int k = 0; k < 3; ++k) {
    const double low = box.min()[k], high = box.max()[k];
    const double center = low + (high - low) / 2.0;
    node.center[k] = center;
    node.half[k] = std::max(0.0, std::max(sub_up(high, center), sub_up(center, low)));
  }
  return node;
}

// Makes nodes[at] and all below it; those are appended.
void build(std::span<Patch> patches, std::size_t at, std::vector<PatchNode>& nodes) {
  Box box = patches[0].box;
  for (const Patch& piece : patches) box.extend(piece.box);
  nodes[at] = node_of(box);
  if (patches.size() == 1) {
    nodes[at].child = ~patches[0].triangle;
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::sort(patches.begin(), patches.end(), [axis](const Patch& a, const Patch& b) {
    const double of_a = a.box.min()[axis] + a.box.max()[axis];
    const double of_b = b.box.min()[axis] + b.box.max()[axis];
    return std::pair(of_a, a.triangle) < std::pair(of_b, b.triangle);
  });
  const std::size_t first = nodes.size();
  nodes[at].child = static_cast<std::int32_t>(first);
  nodes.resize(first + 2);
  build(patches.first(patches.size() / 2), first, nodes);
  build(patches.subspan(patches.size() / 2), first + 1, nodes);
}

}  // namespace

PatchTrees::PatchTrees(std::span<const Patch> patches, std::size_t balls) : roots_(balls, -1) {
  std::vector<Patch> of_ball;
  while (!patches.empty()) {
    const std::int32_t ball = patches[0].ball;
    std::size_t count = 0;
    while (count < patches.size() && patches[count].ball == ball) ++count;
    of_ball.assign(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(count));
    patches = patches.subspan(count);
    roots_[static_cast<std::size_t>(ball)] = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    build(of_ball, nodes_.size() - 1, nodes_);
  }
}

}  // namespace spherule::internal
