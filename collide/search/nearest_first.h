// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "collide/search/deadline.h"
#include "collide/search/query.h"
#include "collide/search/relative_pose.h"
#include "collide/search/traversal.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cstddef>
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
//   void gaps(node, opened, gaps)  of the children, within `error` of the exact ones;
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
    result_.complete = request_.max_node_tests > 0 && !deadline_.passed(0);
    if (!result_.complete) return result_;
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
      result_.complete = tests <= request_.max_node_tests - result_.cost.node_tests &&
                         !deadline_.passed(result_.cost.node_tests);
      if (!result_.complete) break;
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
    space_.gaps(node, opened, gaps);
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

// The node pairs of TreePair as a space of NearestFirst. A leaf test has
//   GapInterval interval(pair)   what the distance of two leaves lies between, each end within
//                                gap_error() of RelativePose;
//   double node_gap(pair)        only where it has one: what no leaves below are nearer than.
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
  void gaps(NodePair pair, const OpenedPair& opened, double* gaps) const {
    sphere_gaps(trees_.spheres(opened.side), opened.first, opened.count, opened.sphere, gaps);
    if constexpr (requires { leaves_.node_gap(pair); }) {
      for (std::int32_t i = 0; i < opened.count; ++i) {
        const NodePair below = child(pair, opened, i);
        if (!is_leaf(below)) gaps[i] = std::max(gaps[i], leaves_.node_gap(below));
      }
    }
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

// Leaf test of two sphere trees.
class SphereLeaves {
 public:
  SphereLeaves(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
               double clearance = 0.0)
      : a_(a), b_(b), pose_(pose), clearance_(clearance) {}

  bool touches(NodePair pair) const {
    return pose_.touches(sphere_a(pair), sphere_b(pair), clearance_);
  }
  double gap(NodePair pair) const { return pose_.gap(sphere_a(pair), sphere_b(pair)); }
  GapInterval interval(NodePair pair) const { return {gap(pair), gap(pair)}; }

 private:
  Sphere sphere_a(NodePair pair) const { return a_.sphere(pair.index(0)); }
  Sphere sphere_b(NodePair pair) const { return b_.sphere(pair.index(1)); }

  const SphereTree& a_;
  const SphereTree& b_;
  const RelativePose& pose_;
  const double clearance_;
};

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
  void gaps(Node, const Opened& opened, double* gaps) const {
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
