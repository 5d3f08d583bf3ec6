// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/distance.h"
#include "collide/search/deadline.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>

namespace spherule::internal {

// Between what a distance lies.
struct GapInterval {
  double lower;
  double upper;
};

// Best-first branch and bound (Hjaltason and Samet, "Distance browsing in spatial databases", 1999)
// over the nodes of a space. The gap of a node is a lower bound of the gap of all leaves below it,
// so whenever the search ends, nothing is nearer than the smaller of the first waiting gap and the
// least lower gap of a leaf, up to the error. Gaps of overlapping nodes are negative and deepest
// first, so that the search of two overlapping sets dives instead of spreading.
//
// A space has
//   Node                        what waits; std::uint64_t key(node) orders those of equal gaps;
//   bool is_leaf(node)
//   Opened open(node)           an inner node's children: their number is .count;
//   void gaps(opened, gaps)     of the children, within `error` of the exact ones;
//   Node child(node, opened, i)
//   GapInterval leaf_gap(leaf)  both within `error` of true bounds;
//   SpherePair pair(leaf)       what it stands for.
template <class Space>
class NearestFirst {
 public:
  using Node = typename Space::Node;

  NearestFirst(const Space& space, double error, const DistanceRequest& request)
      : space_(space), error_(error), request_(request), deadline_(request.max_time) {}

  DistanceResult run(Node root, double root_gap) {
    if (request_.max_node_tests == 0 || deadline_.passed(0)) return result_;
    result_.cost.node_tests = 1;
    if (space_.is_leaf(root)) {
      ++result_.cost.leaf_tests;
      visit_leaf(root);
    } else {
      queue_.push({root_gap, root, space_.key(root)});
    }
    while (!finished()) {
      const Node node = queue_.top().node;
      const auto opened = space_.open(node);
      const auto tests = static_cast<std::uint64_t>(opened.count);
      if (tests > request_.max_node_tests - result_.cost.node_tests) break;
      if (deadline_.passed(result_.cost.node_tests)) break;
      queue_.pop();
      result_.cost.node_tests += tests;
      visit_children(node, opened);
    }
    result_.lower = lower();
    result_.upper = upper();
    return result_;
  }

 private:
  struct Waiting {
    double gap;
    Node node;
    std::uint64_t key;
    // The queue serves its greatest element. Equal gaps are served in an order that does not depend
    // on the queue.
    bool operator<(const Waiting& other) const {
      return gap != other.gap ? gap > other.gap : key < other.key;
    }
  };

  double lower() const {
    const double least = queue_.empty() ? least_lower_ : std::min(least_lower_, queue_.top().gap);
    return std::max(0.0, least * kRelativeDown - error_);
  }
  double upper() const { return std::max(0.0, least_upper_ * kRelativeUp + error_); }

  bool finished() const {
    if (queue_.empty() || queue_.top().gap >= least_upper_) return true;
    if (upper() == 0.0) return true;
    const double proved = lower();
    return proved > request_.enough || upper() - proved <= request_.tolerance;
  }

  template <class Opened>
  void visit_children(Node node, const Opened& opened) {
    double gaps[SphereTree::kMaxBranching];
    space_.gaps(opened, gaps);
    for (std::int32_t i = 0; i < opened.count; ++i) {
      const Node child = space_.child(node, opened, i);
      if (space_.is_leaf(child)) {
        ++result_.cost.leaf_tests;
        visit_leaf(child);
      } else if (gaps[i] < least_upper_) {
        queue_.push({gaps[i], child, space_.key(child)});
      }
    }
  }

  void visit_leaf(Node leaf) {
    const GapInterval gap = space_.leaf_gap(leaf);
    least_lower_ = std::min(least_lower_, gap.lower);
    if (!(gap.upper < least_upper_)) return;
    least_upper_ = gap.upper;
    result_.nearest = space_.pair(leaf);
  }

  const Space& space_;
  const double error_;
  const DistanceRequest& request_;
  Deadline deadline_;
  std::priority_queue<Waiting> queue_;
  double least_lower_ = std::numeric_limits<double>::infinity();
  double least_upper_ = std::numeric_limits<double>::infinity();
  DistanceResult result_;
};

}  // namespace spherule::internal
