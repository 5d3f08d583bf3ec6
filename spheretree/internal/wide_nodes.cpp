// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/internal/wide_nodes.h"

#include <limits>
#include <utility>

namespace spherule::internal {

WideNodes::WideNodes(std::span<const BinaryNode> nodes, int branching)
    : nodes_(nodes), branching_(branching), rows_(nodes.size(), -1) {
  std::int32_t inner = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_leaf()) rows_[i] = inner++;
  }
  costs_.resize(static_cast<std::size_t>(inner) * static_cast<std::size_t>(branching));
  left_slots_.resize(costs_.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!nodes[i].is_leaf()) choose(static_cast<std::int32_t>(i), nodes[0].sphere.radius);
  }
}

std::size_t WideNodes::slot_index(std::int32_t node, int slots) const {
  return static_cast<std::size_t>(rows_[static_cast<std::size_t>(node)]) *
             static_cast<std::size_t>(branching_) +
         static_cast<std::size_t>(slots - 1);
}

float WideNodes::cost(std::int32_t node, int slots) const {
  return at(node).is_leaf() ? 0.0F : costs_[slot_index(node, slots)];
}

void WideNodes::choose(std::int32_t node, double largest_radius) {
  const std::int32_t left = at(node).left, right = at(node).right;
  const double size = largest_radius > 0.0 ? at(node).sphere.radius / largest_radius : 0.0;
  const auto split = [&](int slots) {
    std::pair best(std::numeric_limits<float>::infinity(), 0);
    for (int i = 1; i < slots; ++i) {
      const float sum = cost(left, i) + cost(right, slots - i);
      if (sum < best.first) best = {sum, i};
    }
    return best;
  };
  const auto put = [&](int slots, float least, int left_slots) {
    costs_[slot_index(node, slots)] = least;
    left_slots_[slot_index(node, slots)] = static_cast<std::int8_t>(left_slots);
  };
  const auto [below, own_left_slots] = split(branching_);
  const float kept = below + static_cast<float>(size * size);
  put(1, kept, own_left_slots);
  for (int slots = 2; slots <= branching_; ++slots) {
    const auto [opened, left_slots] = split(slots);
    if (kept < opened) {
      put(slots, kept, 0);
    } else {
      put(slots, opened, left_slots);
    }
  }
}

void WideNodes::collect(std::int32_t node, int slots, std::vector<std::int32_t>& children) const {
  const int left_slots =
      slots == 1 || at(node).is_leaf() ? 0 : left_slots_[slot_index(node, slots)];
  if (left_slots == 0) {
    children.push_back(node);
    return;
  }
  collect(at(node).left, left_slots, children);
  collect(at(node).right, slots - left_slots, children);
}

std::vector<std::int32_t> WideNodes::children(std::int32_t node) const {
  const int left_slots = left_slots_[slot_index(node, 1)];
  std::vector<std::int32_t> children;
  collect(at(node).left, left_slots, children);
  collect(at(node).right, branching_ - left_slots, children);
  return children;
}

}  // namespace spherule::internal
