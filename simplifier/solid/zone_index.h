// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "geometry/median_split.h"
#include "simplifier/types/zones.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace spherule::internal {

// Zones in a hierarchy of boxes, to look up those near a point among hundreds. Immutable and safe
// to share between threads.
class ZoneIndex {
 public:
  ZoneIndex() = default;
  explicit ZoneIndex(std::span<const Zone> zones) : zones_(zones.begin(), zones.end()) {
    order_.resize(zones_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!zones_.empty()) build(0, static_cast<std::int32_t>(zones_.size()));
  }

  const Zone& operator[](std::size_t zone) const { return zones_[zone]; }
  bool empty() const { return zones_.empty(); }

  // Calls visit(zone) with the numbers of all zones that may be within `reach` of the point, and of
  // some others; it returns the reach from there on, which may only shrink. In a fixed order.
  template <typename Visit>
  void near(const Eigen::Vector3d& point, double reach, Visit visit) const {
    // More than the roundings of the squared distance, which may be taken for less than it is.
    constexpr double kSlack = 1.0 + 1e-12;
    const auto may_be_near = [&](const Eigen::AlignedBox3d& box) {
      return box.squaredExteriorDistance(point) <= reach * reach * kSlack + kUnderflow;
    };
    descend(may_be_near, [&](std::size_t zone) { reach = visit(zone); });
  }

  // Calls visit(zone) with the numbers of all zones that hold both points, and of some others, in
  // the same order.
  template <typename Visit>
  void holding(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Visit visit) const {
    descend([&](const Eigen::AlignedBox3d& box) { return box.contains(a) && box.contains(b); },
            visit);
  }

 private:
  // Depth-first order: the left child is the next node; a leaf has right < 0 and holds a zone.
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t right = -1;
    std::size_t zone = 0;
  };

  template <typename Enter, typename Visit>
  void descend(Enter enter, Visit visit) const {
    if (zones_.empty()) return;
    // Halving keeps the depth below 32, and each level leaves at most one node waiting.
    std::array<std::int32_t, 34> waiting{0};
    std::size_t count = 1;
    while (count > 0) {
      const auto at = static_cast<std::size_t>(waiting[--count]);
      const Node& node = nodes_[at];
      if (!enter(node.box)) continue;
      if (node.right < 0) {
        visit(node.zone);
      } else {
        waiting[count++] = node.right;
        waiting[count++] = static_cast<std::int32_t>(at) + 1;
      }
    }
  }

  void build(std::int32_t begin, std::int32_t end) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({});
    for (auto i = begin; i < end; ++i) {
      nodes_[self].box.extend(box_of(order_[static_cast<std::size_t>(i)]));
    }
    if (end - begin == 1) {
      nodes_[self].zone = order_[static_cast<std::size_t>(begin)];
      return;
    }
    const Eigen::Index axis = longest_axis(nodes_[self].box);
    const auto middle = begin + (end - begin) / 2;
    std::stable_sort(order_.begin() + begin, order_.begin() + end,
                     [&](std::size_t a, std::size_t b) {
                       return box_of(a).center()[axis] < box_of(b).center()[axis];
                     });
    build(begin, middle);
    nodes_[self].right = static_cast<std::int32_t>(nodes_.size());
    build(middle, end);
  }

  Eigen::AlignedBox3d box_of(std::size_t zone) const { return bounds(zones_[zone].shape); }

  std::vector<Zone> zones_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace spherule::internal
