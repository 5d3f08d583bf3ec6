// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/nearest_first.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>

namespace spherule::internal {

// The nodes of one tree as a space of NearestFirst. `Gaps` has
//   double gap(sphere)              of the sphere of a node;
//   GapInterval leaf_gap(sphere)  of what the sphere of that index stands for.
// In a pair, `a` is the sphere and `b` is 0.
template <class Gaps>
class SphereSpace {
 public:
  using Node = std::int32_t;
  struct Opened {
    std::int32_t first;
    std::int32_t count;
  };

  SphereSpace(const SphereTree& tree, const Gaps& gaps) : tree_(tree), gaps_(gaps) {}

  static std::uint64_t key(Node node) { return static_cast<std::uint64_t>(node); }
  bool is_leaf(Node node) const { return tree_.is_leaf(static_cast<std::size_t>(node)); }
  Opened open(Node node) const {
    const auto index = static_cast<std::size_t>(node);
    return {tree_.first_child(index), tree_.child_count(index)};
  }
  void gaps(const Opened& opened, double* gaps) const {
    for (std::int32_t i = 0; i < opened.count; ++i) gaps[i] = gap(opened.first + i);
  }
  Node child(Node, const Opened& opened, std::int32_t i) const { return opened.first + i; }
  GapInterval leaf_gap(Node node) const { return gaps_.leaf_gap(pair(node).a); }
  SpherePair pair(Node node) const {
    return {tree_.sphere_index(static_cast<std::size_t>(node)), 0};
  }
  double gap(Node node) const { return gaps_.gap(tree_.sphere(static_cast<std::size_t>(node))); }

 private:
  const SphereTree& tree_;
  const Gaps& gaps_;
};

}  // namespace spherule::internal
