// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/patch_trees.h"

#include "collide/search/box_order.h"
#include "collide/search/single_precision.h"
#include "spheretree/rounding.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

const Box& box_of(const Patch& patch) {
  return patch.box;
}

PatchBox seen_from(const Vector3d& origin, const Box& box) {
  PatchBox result{};
  for (int k = 0; k < 3; ++k) {
    const double low = sub_down(box.min()[k], origin[k]);
    const double high = sub_up(box.max()[k], origin[k]);
    const double center = in_single_precision(low + (high - low) / 2.0);
    const double half = std::max(0.0, std::max(sub_up(high, center), sub_up(center, low)));
    result.center[k] = static_cast<float>(center);
    result.half[k] = rounded_up_to_single(half);
  }
  return result;
}

// Halves the patches across the longest side of their box.
std::pair<std::span<Patch>, std::span<Patch>> halves(std::span<Patch> patches) {
  sort_along_longest_side(patches, box_of, [](const Patch& patch) { return patch.triangle; });
  const std::size_t middle = (patches.size() + 1) / 2;
  return {patches.first(middle), patches.subspan(middle)};
}

// The parts that the boxes of a node get: single patches, or eighths.
std::vector<std::span<Patch>> parts_of(std::span<Patch> patches) {
  std::vector<std::span<Patch>> parts = {patches};
  for (std::size_t count = 1; count < PatchNode::kWidth; count *= 2) {
    std::vector<std::span<Patch>> finer;
    for (const std::span<Patch> part : parts) {
      if (part.size() < 2) {
        finer.push_back(part);
        continue;
      }
      const auto [low, high] = halves(part);
      finer.insert(finer.end(), {low, high});
    }
    parts = std::move(finer);
  }
  return parts;
}

// Appends a node and all below it; returns its index.
std::int32_t build(std::span<Patch> patches, const Vector3d& origin,
                   std::vector<PatchNode>& nodes) {
  const std::size_t at = nodes.size();
  nodes.emplace_back();
  const std::vector<std::span<Patch>> parts = parts_of(patches);
  for (std::size_t i = 0; i < PatchNode::kWidth; ++i) {
    PatchBox box{{0.0F, 0.0F, 0.0F}, {}};
    std::fill_n(box.half, 3, -std::numeric_limits<float>::infinity());
    std::int32_t child = -1;
    if (i < parts.size()) {
      box = seen_from(origin, box_around(parts[i], box_of));
      child = parts[i].size() == 1 ? ~parts[i][0].triangle : build(parts[i], origin, nodes);
    }
    PatchNode& node = nodes[at];
    for (std::size_t k = 0; k < 3; ++k) {
      node.center[k][i] = box.center[k];
      node.half[k][i] = box.half[k];
    }
    node.child[i] = child;
  }
  return static_cast<std::int32_t>(at);
}

}  // namespace

PatchTrees::PatchTrees(std::span<const Patch> patches, std::span<const Sphere> spheres)
    : roots_(spheres.size()) {
  std::vector<Patch> of_sphere;
  while (!patches.empty()) {
    const auto sphere = static_cast<std::size_t>(patches[0].sphere);
    std::size_t count = 0;
    while (count < patches.size() && patches[count].sphere == patches[0].sphere) ++count;
    of_sphere.assign(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(count));
    patches = patches.subspan(count);
    const Vector3d& origin = spheres[sphere].center;
    roots_[sphere] = {seen_from(origin, box_around(std::span(of_sphere), box_of)),
                      build(of_sphere, origin, nodes_)};
  }
}

}  // namespace spherule::internal
