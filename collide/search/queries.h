// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/box_gap.h"
#include "collide/search/deadline.h"
#include "collide/search/query.h"
#include "collide/search/traversal.h"

#include <algorithm>

namespace spherule::internal {

// What a search that has ended, `result.complete` or not, says about two bodies. The query has
// found() and smallest_gap(), the pose its gap_error().
template <class Query, class AnyPose>
void conclude(const Query& query, const AnyPose& pose, CollisionResult& result) {
  std::sort(result.pairs.begin(), result.pairs.end());
  if (query.found()) {
    result.verdict = Verdict::kCollision;
  } else if (result.complete) {
    result.verdict = Verdict::kFree;
    result.distance_lower_bound =
        std::max(0.0, query.smallest_gap() * kRelativeDown - pose.gap_error());
  }
}

}  // namespace spherule::internal

// The yes-or-no query and the query for pairs, for any kind of leaf. A leaf test has
//   bool touches(pair) const        the canonical test of two leaves;
//   double gap(pair) const          their distance: above the exact one by at most gap_error() of
//                                   RelativePose; below it by no more either, but for triangles
//                                   (mesh_tree.h);
//   bool may_touch(pair) const      only where it has one: false for nodes below which no leaves
//                                   touch, though their spheres may.

namespace spherule::internal {

template <class LeafTest>
concept JudgesNodes = requires(const LeafTest& test, NodePair pair) {
  test.may_touch(pair);
};

// Ends at the first pair that touches. Counts nothing.
template <class LeafTest>
class FindAny {
 public:
  static constexpr bool kNeedsGaps = false;

  explicit FindAny(const LeafTest& test) : test_(test) {}

  bool afford(const OpenedPair&, const auto&) const noexcept { return true; }
  bool leaves(NodePair pair) noexcept {
    found_ = test_.touches(pair);
    return !found_;
  }
  bool found() const { return found_; }

 protected:
  const LeafTest& test() const { return test_; }

 private:
  const LeafTest& test_;
  bool found_ = false;
};

// Collects the pairs that touch, up to the limits of a request, and the smallest gap seen.
template <class LeafTest>
class CollectPairs {
 public:
  static constexpr bool kNeedsGaps = true;

  CollectPairs(const LeafTest& test, const SphereTree& a, const SphereTree& b,
               const CollisionRequest& request, CollisionResult& result)
      : test_(test),
        a_(a),
        b_(b),
        request_(request),
        deadline_(request.max_time),
        result_(result) {}

  bool out_of_time() { return deadline_.passed(result_.cost.node_tests); }

  bool afford(const OpenedPair& opened, const auto& leaf_pairs) {
    const auto tests = static_cast<std::uint64_t>(opened.count);
    if (tests > request_.max_node_tests - result_.cost.node_tests) return false;
    if (out_of_time()) return false;
    result_.cost.node_tests += tests;
    result_.cost.leaf_tests += leaf_pairs();
    return true;
  }

  void pruned(double gap) { smallest_gap_ = std::min(smallest_gap_, gap); }

  bool leaves(NodePair pair) {
    if (!test_.touches(pair)) {
      pruned(test_.gap(pair));
      return true;
    }
    found_ = true;
    if (result_.pairs.size() < request_.max_pairs) {
      result_.pairs.push_back({a_.sphere_index(pair.index(0)), b_.sphere_index(pair.index(1))});
    }
    return result_.pairs.size() < request_.max_pairs;
  }

  bool found() const { return found_; }
  double smallest_gap() const { return smallest_gap_; }

 private:
  const LeafTest& test_;
  const SphereTree& a_;
  const SphereTree& b_;
  const CollisionRequest& request_;
  Deadline deadline_;
  CollisionResult& result_;
  bool found_ = false;
  double smallest_gap_ = std::numeric_limits<double>::infinity();
};

// The same for pairs that come within a clearance, of which the leaf test knows.
template <class LeafTest>
class FindNear : public FindAny<LeafTest> {
 public:
  FindNear(const LeafTest& test, double clearance)
      : FindAny<LeafTest>(test), clearance_(clearance) {}

  double margin(NodePair) const noexcept { return clearance_; }
  bool enters(NodePair pair) const noexcept requires requires(const LeafTest& leaves) {
    leaves.may_touch(pair);
  }
  { return this->test().may_touch(pair); }
  bool nearest_first() const noexcept { return false; }

 private:
  const double clearance_;
};

template <class LeafTest>
bool any_pair(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
              const LeafTest& test) noexcept {
  FindAny<LeafTest> query(test);
  traverse(a, b, pose, query);
  return query.found();
}

template <class LeafTest>
bool any_pair_within(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
                     const LeafTest& test, double clearance) noexcept {
  FindNear<LeafTest> query(test, clearance);
  traverse(a, b, pose, query);
  return query.found();
}

template <class LeafTest>
CollisionResult all_pairs(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
                          const LeafTest& test, const CollisionRequest& request) {
  CollisionResult result;
  CollectPairs<LeafTest> query(test, a, b, request, result);
  if (request.max_node_tests == 0 || query.out_of_time()) return result;
  result.cost.node_tests = 1;
  result.cost.leaf_tests = a.is_leaf(0) && b.is_leaf(0) ? 1 : 0;

  if (pose.may_touch(a.sphere(0), b.sphere(0)) && !boxes_apart(a, b, pose)) {
    // Between two leaves nothing is left to cut short but the pair itself.
    result.complete = traverse(a, b, pose, query) && !(query.found() && request.max_pairs == 0);
  } else {
    query.pruned(std::max(pose.gap(a.sphere(0), b.sphere(0)), box_gap(a, b, pose)));
    result.complete = true;
  }
  conclude(query, pose, result);
  return result;
}

}  // namespace spherule::internal
