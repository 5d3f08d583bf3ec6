// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/deadline.h"
#include "collide/search/query.h"
#include "collide/search/traversal.h"

#include <optional>

namespace spherule::internal {

// Limits of a query that may be made of several traversals, and what has been spent of them.
struct Limits {
  std::uint64_t max_node_tests;
  Deadline deadline;
  QueryCost cost;

  // Whether so many more tests may be done; counts them if so.
  bool afford(std::uint64_t tests) {
    if (tests > max_node_tests - cost.node_tests) return false;
    if (deadline.passed(cost.node_tests)) return false;
    cost.node_tests += tests;
    return true;
  }
};

// What one evaluation of two placed trees has found.
struct Evaluation {
  bool complete = false;  // not cut short by a limit
  bool contact = false;   // the canonical test with the clearance accepts `pair`
  SpherePair pair;
  // Every pair of spheres stays farther apart than the clearance for this long, whichever way time
  // goes: what was requested, or a half, a quarter ... of it, or 0 if nothing is known.
  double free_time = 0.0;
  // The pair of leaves that shortened the time last, worth a try in the next evaluation.
  std::optional<NodePair> decisive;
};

// Traversal policy: branch and bound, depth first, for the shortest time in which some pair of
// leaves could come within a clearance, and a test of contact at once. A Rate knows how fast pairs
// of spheres approach:
//   double approach(sphere_a, sphere_b, time)         upper bound for all spheres below two nodes;
//   double free_time(center_a, center_b, gap)     for two leaves: in this time they do not use up
//                                                 the gap; the bound above does by the time of
//                                                 (1 + 96 u) times as much at the latest.
// The time requested is halved until no leaf has less. So it is the same in whatever order leaves
// are visited and whatever the trees above them are: a node is pruned only if all its leaves, with
// all rounding, have at least the time known. Halves, because to narrow the time down to the exact
// one takes up to twice as long: it means to search among all leaves of nearly the same.
template <class Rate>
class FreeTime {
 public:
  static constexpr bool kNeedsGaps = false;

  // A gap counts only for what it exceeds clearance + `reserve` by. As soon as the time falls below
  // `useful` it is given up, and the traversal goes on only to find a contact.
  FreeTime(const SphereTree& a, const SphereTree& b, const RelativePose& pose, const Rate& rate,
           double clearance, double reserve, double wanted, double useful, Limits& limits)
      : a_(a),
        b_(b),
        pose_(pose),
        rate_(rate),
        clearance_(clearance),
        taken_((pose.leaf_pad() + clearance + reserve) * kUp),
        prune_(taken_ + 4.0 * pose.gap_error()),
        useful_(useful),
        limits_(limits) {
    evaluation_.free_time = wanted;
  }

  // A pair of leaves to `try_first`, if any, only saves work.
  Evaluation run(std::optional<NodePair> try_first) {
    if (!limits_.afford(try_first ? 2 : 1)) return {};
    limits_.cost.leaf_tests += a_.is_leaf(0) && b_.is_leaf(0) ? 1u : 0u;
    if (try_first) {
      ++limits_.cost.leaf_tests;
      leaves(*try_first);
    }
    evaluation_.complete = evaluation_.contact ||
                           !pose_.may_touch(a_.sphere(0), b_.sphere(0), margin(NodePair(0, 0))) ||
                           traverse(a_, b_, pose_, *this) || evaluation_.contact;
    if (!evaluation_.complete || evaluation_.contact) evaluation_.free_time = 0.0;
    return evaluation_;
  }

  bool afford(const OpenedPair& opened, const auto& leaf_pairs) {
    if (!limits_.afford(static_cast<std::uint64_t>(opened.count))) return false;
    limits_.cost.leaf_tests += leaf_pairs();
    return true;
  }

  double margin(NodePair pair) const {
    if (evaluation_.free_time == 0.0) return clearance_;
    const double way =
        rate_.approach(a_.sphere(pair.index(0)), b_.sphere(pair.index(1)), evaluation_.free_time);
    return way * kWayUp + prune_;
  }

  bool nearest_first() const { return evaluation_.free_time > 0.0; }

  bool leaves(NodePair pair) {
    const Sphere a = a_.sphere(pair.index(0));
    const Sphere b = b_.sphere(pair.index(1));
    if (pose_.touches(a, b, clearance_)) {
      evaluation_.contact = true;
      evaluation_.decisive = pair;
      evaluation_.pair = {a_.sphere_index(pair.index(0)), b_.sphere_index(pair.index(1))};
      return false;
    }
    if (evaluation_.free_time == 0.0) return true;
    // The factor covers the roundings of the gap and of the difference.
    const double gap = pose_.gap(a, b) * kRelativeDown - taken_;
    const double time = gap > 0.0 ? rate_.free_time(a.center, b.center, gap * kRelativeDown) : 0.0;
    if (evaluation_.free_time > time) evaluation_.decisive = pair;
    while (evaluation_.free_time > time) {
      evaluation_.free_time *= 0.5;
      if (evaluation_.free_time < useful_) evaluation_.free_time = 0.0;
    }
    return true;
  }

 private:
  static constexpr double kUp = 1.0 + 16.0 * kUnitRoundoff;
  static constexpr double kWayUp = 1.0 + 256.0 * kUnitRoundoff;

  const SphereTree& a_;
  const SphereTree& b_;
  const RelativePose& pose_;
  const Rate& rate_;
  const double clearance_;
  // Of a computed gap, before it counts. The gap of two spheres is computed from the offset of the
  // canonical test, which errs by 67.2 u S, and with six more roundings: less than the 76 u S of
  // the leaf pad. Unlike gap_error() this does not depend on the trees.
  const double taken_;
  const double prune_;
  const double useful_;
  Limits& limits_;
  Evaluation evaluation_;
};

}  // namespace spherule::internal
