// SPDX-License-Identifier: BSD-3-Clause
#include "collide/distance.h"

#include "collide/internal/ball_leaves.h"
#include "collide/internal/deadline.h"

#include <algorithm>
#include <queue>
#include <vector>

namespace spherule {
namespace {

// Best-first branch and bound (Hjaltason and Samet, "Distance browsing in spatial databases", 1999)
// over the node pairs of TreePair. The gap of two nodes is a lower bound of the gap of all leaves
// below them, so whenever the search ends, no pair is nearer than the smaller of the first waiting
// gap and the best leaf gap, up to gap_error(). Gaps of overlapping nodes are negative and deepest
// first, so that the search of two overlapping sets dives instead of spreading.
class Search {
 public:
  Search(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
         const DistanceRequest& request)
      : a_(a),
        b_(b),
        error_(pose.gap_error()),
        request_(request),
        deadline_(request.max_time),
        trees_(a, b, pose),
        leaves_(a, b, pose) {}

  DistanceResult run(double root_gap) {
    if (request_.max_node_tests == 0 || deadline_.passed(0)) return result_;
    result_.cost.node_tests = 1;
    if (trees_.is_leaf_pair(NodePair(0, 0))) {
      ++result_.cost.leaf_tests;
      visit_leaves(NodePair(0, 0));
    } else {
      queue_.push({root_gap, NodePair(0, 0)});
    }
    while (!finished()) {
      const NodePair pair = queue_.top().pair;
      const OpenedPair opened = trees_.open(pair);
      const auto tests = static_cast<std::uint64_t>(opened.count);
      if (tests > request_.max_node_tests - result_.cost.node_tests) break;
      if (deadline_.passed(result_.cost.node_tests)) break;
      queue_.pop();
      result_.cost.node_tests += tests;
      visit_children(pair, opened);
    }
    result_.lower = lower();
    result_.upper = upper();
    return result_;
  }

 private:
  struct Waiting {
    double gap;
    NodePair pair;
    // The queue serves its greatest element. Equal gaps are served in an order that does not depend
    // on the queue.
    bool operator<(const Waiting& other) const {
      if (gap != other.gap) return gap > other.gap;
      if (pair.node(0) != other.pair.node(0)) return pair.node(0) < other.pair.node(0);
      return pair.node(1) < other.pair.node(1);
    }
  };

  double lower() const {
    const double least = queue_.empty() ? best_gap_ : std::min(best_gap_, queue_.top().gap);
    return std::max(0.0, least * kRelativeDown - error_);
  }
  double upper() const { return std::max(0.0, best_gap_ * kRelativeUp + error_); }

  bool finished() const {
    if (queue_.empty() || queue_.top().gap >= best_gap_) return true;
    if (upper() == 0.0) return true;
    const double proved = lower();
    return proved > request_.enough || upper() - proved <= request_.tolerance;
  }

  void visit_children(NodePair pair, const OpenedPair& opened) {
    double gaps[SphereTree::kMaxBranching];
    internal::ball_gaps(trees_.balls(opened.side), opened.first, opened.count, opened.ball, gaps);
    for (std::int32_t i = 0; i < opened.count; ++i) {
      const NodePair child = pair.with(opened.side, opened.first + i);
      const bool leaves = trees_.is_leaf_pair(child);
      result_.cost.leaf_tests += leaves ? 1u : 0u;
      if (leaves) {
        visit_leaves(child);
      } else if (gaps[i] < best_gap_) {
        queue_.push({gaps[i], child});
      }
    }
  }

  void visit_leaves(NodePair pair) {
    const double gap = leaves_.gap(pair);
    if (!(gap < best_gap_)) return;
    best_gap_ = gap;
    result_.nearest = {a_.sphere_index(pair.index(0)), b_.sphere_index(pair.index(1))};
  }

  const SphereTree& a_;
  const SphereTree& b_;
  const double error_;
  const DistanceRequest& request_;
  internal::Deadline deadline_;
  const TreePair trees_;
  const internal::BallLeaves leaves_;
  std::priority_queue<Waiting> queue_;
  double best_gap_ = std::numeric_limits<double>::infinity();
  DistanceResult result_;
};

}  // namespace

DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  const RelativePose pose(a, world_from_a, b, world_from_b);
  return Search(a, b, pose, request).run(pose.gap(a.ball(0), b.ball(0)));
}

}  // namespace spherule
