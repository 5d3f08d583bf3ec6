// SPDX-License-Identifier: BSD-3-Clause
#include "collide/sweep.h"

#include "base/error.h"
#include "collide/collide.h"
#include "collide/motion/free_time.h"
#include "collide/motion/gap_rate.h"
#include "collide/shapes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

// Proof of G6. At an evaluation, t = m, the traversal finds a lower bound g of the gap of every
// pair of spheres under exactly the poses pose_at(m), and from
//     g - clearance - 2 E - (largest slack of the canonical test at any t)
// the time in which the pair cannot use that up. Here E = pose_error(a) + pose_error(b), and each
// of these bounds the distance of a pose from the motion that is stored plus the distance of that
// from the motion that was requested. GapRate speaks of the stored motions. So from pose_at(m) to
// the motions requested, at any t within that time of m, the gap shrinks by no more than E and the
// way: it stays above the clearance. From pose_at(m) to pose_at(t) it shrinks by no more than 2 E
// and the way: it stays above the clearance by more than the slack, and the canonical test does not
// accept the pair there.
//
// The intervals are proved closed and cover [0, 1]: an evaluation at m proves [m - time, m + time],
// whose ends are rounded inward, and what is left of the interval to either side of these ends,
// which are part of it, waits its turn.

namespace spherule {
namespace {

using internal::Evaluation;
using internal::GapRate;
using internal::Limits;

constexpr double kFinest = 0x1p-40;
// If less than this part of an interval can be proved from its middle, its exact length is not
// worth the search.
constexpr double kUseful = 0.25;

// Largest slack of the canonical test with the clearance, at any t: RelativePose::slack() with the
// frames as far apart as they get. The sum of three coordinates is at most sqrt(3) times the norm.
double largest_slack(const SphereTree& a, const SphereTree& b, const GapRate& rate,
                     double pose_errors, double clearance) {
  const double apart = 1.7321 * (rate.farthest_frames() + pose_errors);
  const double scene = ((a.reach() + b.reach()) + apart) * (1.0 + 16.0 * kUnitRoundoff);
  return internal::kSlack * scene + 16.0 * kUnitRoundoff * clearance + 8.0 * kUnderflow;
}

// What an instant of two moving trees shows.
class TreeInstants {
 public:
  TreeInstants(const SphereTree& a, const Motion& motion_a, const SphereTree& b,
               const Motion& motion_b, const SweepRequest& request)
      : a_(a),
        b_(b),
        motion_a_(motion_a),
        motion_b_(motion_b),
        clearance_(request.clearance),
        rate_(a, motion_a, b, motion_b) {
    const double errors = motion_a.pose_error(a.reach()) + motion_b.pose_error(b.reach());
    reserve_ = 2.0 * errors + largest_slack(a, b, rate_, errors, clearance_);
  }

  Evaluation evaluate(double t, double wanted, double useful, Limits& limits) {
    const Pose world_from_a = motion_a_.pose_at(t);
    const Pose world_from_b = motion_b_.pose_at(t);
    const internal::RelativePose pose(a_, world_from_a, b_, world_from_b);
    internal::FreeTime query(a_, b_, pose, rate_, clearance_, reserve_, wanted, useful, limits);
    const Evaluation evaluation = query.run(decisive_);
    if (evaluation.decisive) decisive_ = evaluation.decisive;
    return evaluation;
  }

 private:
  const SphereTree& a_;
  const SphereTree& b_;
  const Motion& motion_a_;
  const Motion& motion_b_;
  const double clearance_;
  const GapRate rate_;
  double reserve_ = 0.0;
  std::optional<internal::NodePair> decisive_;  // of an earlier evaluation
};

// Of any two shapes: their distance, and how far any of their points can move. From the middle of
// an interval to the motions requested the gap shrinks by no more than E and the way (see above).
class ShapeInstants {
 public:
  ShapeInstants(const ShapeRef& a, const Motion& motion_a, const ShapeRef& b,
                const Motion& motion_b, const SweepRequest& request)
      : a_(a),
        b_(b),
        motion_a_(motion_a),
        motion_b_(motion_b),
        clearance_(request.clearance),
        of_a_(internal::extent_of(a)),
        of_b_(internal::extent_of(b)),
        are_bounded_(of_a_.is_bounded && of_b_.is_bounded),
        rate_(reach_of(of_a_), motion_a, reach_of(of_b_), motion_b) {
    // The point of a half-space that is nearest to a point is no farther from the origin than that.
    double reach_a = reach_of(of_a_), reach_b = reach_of(of_b_);
    if (!of_b_.is_bounded) reach_b = reach_a + rate_.farthest_frames();
    if (!of_a_.is_bounded) reach_a = reach_b + rate_.farthest_frames();
    reserve_ = (motion_a.pose_error(reach_a) + motion_b.pose_error(reach_b)) * (1.0 + 1e-9);
  }

  Evaluation evaluate(double t, double wanted, double useful, Limits& limits) {
    const Pose world_from_a = motion_a_.pose_at(t);
    const Pose world_from_b = motion_b_.pose_at(t);
    DistanceRequest request;
    request.enough = needed(wanted);
    request.max_node_tests = limits.max_node_tests - limits.cost.node_tests;
    request.max_time = limits.deadline.left();
    const DistanceResult found = distance(a_, world_from_a, b_, world_from_b, request);
    limits.cost.node_tests += found.cost.node_tests;
    limits.cost.leaf_tests += found.cost.leaf_tests;
    const bool may_touch = !(found.lower > clearance_);
    Evaluation evaluation;
    evaluation.complete = found.complete || !may_touch;
    evaluation.contact =
        found.complete && may_touch && within(a_, world_from_a, b_, world_from_b, clearance_);
    evaluation.pair = found.nearest;
    evaluation.free_time = may_touch ? 0.0 : wanted;
    while (evaluation.free_time > 0.0 && !(found.lower > needed(evaluation.free_time))) {
      evaluation.free_time *= 0.5;
      if (evaluation.free_time < useful) evaluation.free_time = 0.0;
    }
    return evaluation;
  }

 private:
  static double reach_of(const internal::Extent& extent) {
    if (!extent.is_bounded) return std::numeric_limits<double>::infinity();
    return add_up(extent.around.radius, norm_upper(extent.around.center));
  }

  // A gap that is not used up in that time.
  double needed(double time) const {
    const double way =
        are_bounded_ ? rate_.approach(of_a_.around, of_b_.around, time) : rate_.approach(time);
    return (clearance_ + reserve_ + way) * (1.0 + 16.0 * kUnitRoundoff);
  }

  const ShapeRef& a_;
  const ShapeRef& b_;
  const Motion& motion_a_;
  const Motion& motion_b_;
  const double clearance_;
  const internal::Extent of_a_;
  const internal::Extent of_b_;
  const bool are_bounded_;
  const GapRate rate_;
  double reserve_ = 0.0;
};

// Adaptive bisection. `evaluate(t, wanted, useful, limits)` of the instants is that of FreeTime.
template <class Instants>
class Sweep {
 public:
  Sweep(Instants instants, const SweepRequest& request)
      : instants_(std::move(instants)),
        request_(request),
        limits_{request.max_node_tests, internal::Deadline(request.max_time), {}} {}

  SweepResult run() {
    push(0.0, 1.0);
    while (waiting_ > 0 && advance()) {
    }
    if (waiting_ == 0 && !in_contact()) {
      result_.verdict = Verdict::kFree;
      result_.free_until = 1.0;
    } else if (in_contact()) {
      result_.verdict = Verdict::kCollision;
    }
    result_.cost = limits_.cost;
    return result_;
  }

 private:
  struct Interval {
    double first;
    double last;
  };

  bool in_contact() const { return result_.contact_at <= 1.0; }

  // The one to be examined next is on top; those below it follow it in time.
  void push(double first, double last) {
    assert(waiting_ < intervals_.size());
    intervals_[waiting_++] = {first, last};
  }

  // Examines the first interval not proved. False if the search ends with it.
  bool advance() {
    const auto [first, last] = intervals_[--waiting_];
    result_.free_until = first;
    const double middle = 0.5 * (first + last);
    // Rounded up, so that it reaches both ends.
    const double half = next_up(std::max(middle - first, last - middle));
    const bool smallest = last - first <= request_.resolution;
    const Evaluation evaluation = evaluate(middle, half, smallest ? half : kUseful * half);
    if (!evaluation.complete) return stop(first, last);
    if (evaluation.contact) {
      waiting_ = 0;  // what follows the contact does not matter any more
      if (!smallest) {
        push(first, middle);
        return true;
      }
    }
    if (!evaluation.contact && evaluation.free_time >= half) return true;
    if (smallest) {
      hunt(first, last);
      return stop(first, last);
    }
    // Nothing known means no time: the middle then belongs to both parts.
    push(std::clamp(add_down(middle, evaluation.free_time), middle, last), last);
    push(first, std::clamp(sub_up(middle, evaluation.free_time), first, middle));
    return true;
  }

  // The interval remains unproved.
  bool stop(double first, double last) {
    push(first, last);
    return false;
  }

  // Searches for a contact at the start of an interval that could not be proved and, while none is
  // known, behind it, at distances that double: a motion that goes on into the obstacle is soon
  // there. Without one the answer would be kUnknown, which is as true and tells less.
  void hunt(double first, double last) {
    double t = first;
    double next = last;
    double step = last - first;
    while (evaluate(t, 0.0, 0.0).complete && !in_contact() && t < 1.0) {
      t = next;
      next = std::min(1.0, t + step);
      step *= 2.0;
    }
  }

  Evaluation evaluate(double t, double wanted, double useful) {
    const Evaluation evaluation = instants_.evaluate(t, wanted, useful, limits_);
    ++result_.evaluations;
    if (evaluation.contact && t < result_.contact_at) {
      result_.contact_at = t;
      result_.contact = evaluation.pair;
    }
    return evaluation;
  }

  Instants instants_;
  const SweepRequest& request_;
  Limits limits_;
  // Dividing replaces an interval by two of at most half its length, so one interval of each length
  // waits, and only those longer than kFinest are divided: 42 at most.
  std::array<Interval, 48> intervals_;
  std::size_t waiting_ = 0;
  SweepResult result_;
};

void require_request(const SweepRequest& request) {
  require_clearance(request.clearance);
  if (!(request.resolution >= kFinest && request.resolution <= 1.0)) {
    throw Error("sweep", "the resolution is not a number from 2^-40 to 1");
  }
}

}  // namespace

SweepResult sweep(const SphereTree& a, const Motion& motion_a, const SphereTree& b,
                  const Motion& motion_b, const SweepRequest& request) {
  require_request(request);
  return Sweep(TreeInstants(a, motion_a, b, motion_b, request), request).run();
}

SweepResult sweep(const ShapeRef& a, const Motion& motion_a, const ShapeRef& b,
                  const Motion& motion_b, const SweepRequest& request) {
  require_request(request);
  const auto tree_of = [](const ShapeRef& shape) {
    const auto* const tree = std::get_if<const SphereTree*>(&shape.get());
    return tree != nullptr ? *tree : nullptr;
  };
  if (tree_of(a) != nullptr && tree_of(b) != nullptr) {
    return sweep(*tree_of(a), motion_a, *tree_of(b), motion_b, request);
  }
  return Sweep(ShapeInstants(a, motion_a, b, motion_b, request), request).run();
}

void require_resolution(double resolution) {
  if (!(resolution > 0.0)) throw Error("resolution", "it is not above zero");
}

}  // namespace spherule
