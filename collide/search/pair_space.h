// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/nearest_first.h"
#include "collide/search/tree_pair.h"

#include <cstdint>

namespace spherule::internal {

// The node pairs of TreePair as a space of NearestFirst. A leaf test has
//   GapInterval interval(pair)   what the distance of two leaves lies between, each end within
//                                gap_error() of RelativePose.
template <class LeafTest>
class PairSpace {
 public:
  using Node = NodePair;

  PairSpace(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
            const LeafTest& leaves)
      : a_(a), b_(b), trees_(a, b, pose), leaves_(leaves) {}

  static std::uint64_t key(NodePair pair) {
    return static_cast<std::uint64_t>(pair.index(0)) << 32 | pair.index(1);
  }
  bool is_leaf(NodePair pair) const { return trees_.is_leaf_pair(pair); }
  OpenedPair open(NodePair pair) const { return trees_.open(pair); }
  void gaps(const OpenedPair& opened, double* gaps) const {
    sphere_gaps(trees_.spheres(opened.side), opened.first, opened.count, opened.sphere, gaps);
  }
  NodePair child(NodePair pair, const OpenedPair& opened, std::int32_t i) const {
    return pair.with(opened.side, opened.first + i);
  }
  GapInterval leaf_gap(NodePair pair) const { return leaves_.interval(pair); }
  SpherePair pair(NodePair pair) const {
    return {a_.sphere_index(pair.index(0)), b_.sphere_index(pair.index(1))};
  }

 private:
  const SphereTree& a_;
  const SphereTree& b_;
  const TreePair trees_;
  const LeafTest& leaves_;
};

}  // namespace spherule::internal
