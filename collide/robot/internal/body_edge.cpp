// SPDX-License-Identifier: BSD-3-Clause

// How far two bodies move against each other along a part of a straight motion in joint space.
//
// Of the joints that lie on the way from one body to the other only these matter, whatever moves
// both. Let them be numbered from the first body on, let the position of joint k differ by at most
// D_k from its value q_k in the middle of the part, and follow a point of the first body from link
// to link along the way, as seen from each. As seen from its own link it stands still. Let it be at
// y as seen from the link before joint k and at y' in the middle, |y - y'| <= e, and let T be what
// joint k does, from the coordinates of the link before it to those of the link behind: a turn
// about a line that is fixed in both, or a shift. Then
//     |T(q) y - T(q_k) y'| <= |T(q) y - T(q) y'| + |T(q) y' - T(q_k) y'|,
// of which the first is |y - y'| <= e, and the second at most min(D_k, 2) times the distance d_k of
// y' from the line (a chord is not longer than its arc, nor than the diameter), or D_k for a shift.
// So the point has moved by at most the sum of min(D_k, 2) d_k over the joints passed, each d_k
// taken in the middle of the part. It is no matter on which side of a joint the root of the robot
// is. For all points of a body, d_k is at most the distance of the centre of the ball around them
// from the line, plus its radius.
//
// Any link on the way will do to look at both bodies from: the first one moves there by its sum
// over the joints before that link, the second one by its own over those behind. The gap of the two
// shrinks by no more than both together, and the smallest over all links on the way counts:
//     best_0 = 0,  best_k = min(d_1 + ... + d_k of the first, best_(k-1) + d_k of the second).
// An obstacle hangs on the root, and only the first body's sums are taken.
//
// Rounding. Let e be pose_error(): it bounds how far a point of a link is from where the exact
// mechanism has it, and 360 u (n + 2) W of it are left besides, W bounding all lengths involved and
// n >= 1 being the number of joints. In the middle, the placed centre and the joint's line are
// within e of those of the exact mechanism, the line's direction within 60 u (n + 2): a computed
// distance from the line errs by less than 2 e. The middle itself, made of rounded fractions of
// positions up to 100, errs by less than 9 u times 100 < kMiddleError, which D_k takes up. The sum
// errs by far less than kRelative of it. From the poses that are looked at to the exact mechanism,
// and from there to the poses computed for any other configuration of the part, are e for each
// body: 4 e cover these with the slack of the canonical test there, of less than 840 u W.

#include "collide/edge_halving.h"
#include "collide/robot/internal/body_pairs.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {
namespace {

constexpr double kMiddleError = 1e-12;
constexpr double kRelative = 1e-9;

}  // namespace

double BodyPairs::turning_radius(const Sphere& ball, int joint, const Memory& memory) const {
  const auto j = static_cast<std::size_t>(joint);
  const auto link = static_cast<std::size_t>(robot_.joints()[j].child_link);
  const Eigen::Vector3d offset = ball.center - memory.world_from_link[link].translation();
  return offset.cross(memory.axes[j]).norm() + (ball.radius + 2.0 * pose_error_);
}

double BodyPairs::growth(std::size_t index, double half, const Memory& memory) const {
  const CheckedPair& pair = pairs_[index];
  const Sphere& first = memory.placed[static_cast<std::size_t>(pair.piece)];
  double of_first = 0.0;
  double best = 0.0;
  for (const int j : paths_[index]) {
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(j)];
    const double change =
        std::abs(joint.multiplier) *
        (memory.changes[static_cast<std::size_t>(joint.variable)] * half + kMiddleError);
    if (!joint.turns()) {
      of_first += change;
      best += change;
      continue;
    }
    const double chord = std::min(change, 2.0);
    of_first += chord * turning_radius(first, j, memory);
    if (pair.is_obstacle) {
      best = of_first;
    } else {
      const Sphere& second = memory.placed[static_cast<std::size_t>(pair.other)];
      best = std::min(of_first, best + chord * turning_radius(second, j, memory));
    }
  }
  return best * (1.0 + kRelative) + 4.0 * pose_error_;
}

// The motion as EdgeHalving asks for it.
class BodyPairs::EdgeMotion {
 public:
  EdgeMotion(const BodyPairs& pairs, std::span<const double> from, std::span<const double> to,
             Memory& memory)
      : pairs_(pairs), from_(from), to_(to), memory_(memory) {
    memory_.variables.resize(from.size());
    memory_.changes.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      memory_.changes[i] = std::abs(to[i] - from[i]) * (1.0 + kRelative);
    }
  }

  void set(double at, std::uint64_t) {
    for (std::size_t i = 0; i < from_.size(); ++i) {
      memory_.variables[i] = (1.0 - at) * from_[i] + at * to_[i];
    }
    pairs_.place(memory_.variables, memory_);
    const std::vector<Joint>& joints = pairs_.robot_.joints();
    memory_.axes.resize(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].moves()) continue;
      const auto link = static_cast<std::size_t>(joints[j].child_link);
      memory_.axes[j] = memory_.world_from_link[link].matrix() * joints[j].axis;
    }
  }

  PartFinding look(std::int32_t open, double half, double& growth) const {
    const auto pair = static_cast<std::size_t>(open);
    growth = pairs_.growth(pair, half, memory_);
    if (!pairs_.is_near(pairs_.pairs_[pair], growth, memory_)) return PartFinding::kApart;
    return pairs_.touches(pair, memory_) ? PartFinding::kTouch : PartFinding::kNear;
  }

  bool touches() { return pairs_.any_touches(memory_); }

 private:
  const BodyPairs& pairs_;
  std::span<const double> from_;
  std::span<const double> to_;
  Memory& memory_;
};

EdgeResult BodyPairs::check_edge(std::span<const double> from, std::span<const double> to,
                                 double end, const EdgeRequest& request, Memory& memory) const {
  using Halving = EdgeHalving<EdgeMotion>;
  memory.open_pairs.resize(Halving::list_size(tested_));
  EdgeMotion motion(*this, from, to, memory);
  return Halving(motion, memory.open_pairs, request, end).run();
}

}  // namespace spherule::internal
