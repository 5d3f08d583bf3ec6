// SPDX-License-Identifier: BSD-3-Clause
#include "collide/sweep.h"

#include "base/error.h"
#include "collide/collide.h"
#include "collide/motion/free_time.h"
#include "collide/motion/gap_rate.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

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

class Sweep {
 public:
  Sweep(const SphereTree& a, const Motion& motion_a, const SphereTree& b, const Motion& motion_b,
        const SweepRequest& request)
      : a_(a),
        b_(b),
        motion_a_(motion_a),
        motion_b_(motion_b),
        request_(request),
        rate_(a, motion_a, b, motion_b),
        limits_{request.max_node_tests, internal::Deadline(request.max_time), {}} {
    const double errors = motion_a.pose_error(a.reach()) + motion_b.pose_error(b.reach());
    reserve_ = 2.0 * errors + largest_slack(a, b, rate_, errors, request.clearance);
  }

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
    const Pose world_from_a = motion_a_.pose_at(t);
    const Pose world_from_b = motion_b_.pose_at(t);
    const internal::RelativePose pose(a_, world_from_a, b_, world_from_b);
    internal::FreeTime query(a_, b_, pose, rate_, request_.clearance, reserve_, wanted, useful,
                             limits_);
    const Evaluation evaluation = query.run(decisive_);
    if (evaluation.decisive) decisive_ = evaluation.decisive;
    ++result_.evaluations;
    if (evaluation.contact && t < result_.contact_at) {
      result_.contact_at = t;
      result_.contact = evaluation.pair;
    }
    return evaluation;
  }

  const SphereTree& a_;
  const SphereTree& b_;
  const Motion& motion_a_;
  const Motion& motion_b_;
  const SweepRequest& request_;
  const GapRate rate_;
  double reserve_ = 0.0;
  Limits limits_;
  // Dividing replaces an interval by two of at most half its length, so one interval of each length
  // waits, and only those longer than kFinest are divided: 42 at most.
  std::array<Interval, 48> intervals_;
  std::size_t waiting_ = 0;
  std::optional<internal::NodePair> decisive_;  // of an earlier evaluation
  SweepResult result_;
};

}  // namespace

SweepResult sweep(const SphereTree& a, const Motion& motion_a, const SphereTree& b,
                  const Motion& motion_b, const SweepRequest& request) {
  require_clearance(request.clearance);
  if (!(request.resolution >= kFinest && request.resolution <= 1.0)) {
    throw Error("sweep", "the resolution is not a number from 2^-40 to 1");
  }
  return Sweep(a, motion_a, b, motion_b, request).run();
}

void require_resolution(double resolution) {
  if (!(resolution > 0.0)) throw Error("resolution", "it is not above zero");
}

}  // namespace spherule
