// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/motion/motion.h"
#include "collide/search/relative_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule::internal {

// How fast two spheres can approach each other while both bodies move: the bounds behind G6.
//
// A sphere turned about its own centre is the same sphere, so only the ways of the centres count.
// With the velocities v of the reference points, the angular speeds w (the angle, as t goes from 0
// to 1) and the distance rho of a centre from the axis through the reference point, in a time tau
//   1. a centre moves by at most |va - vb| tau + (|wa| rho_a + |wb| rho_b) tau against the other;
//   2. and turning moves it by at most the diameter of its circle, so the sum in parentheses can be
//      replaced by 2 (rho_a + rho_b);
//   3. seen from body b, a point x of a moves with the velocity
//        va + wa x (x - ca) - vb - wb x (x - cb) = (va - vb) + (wa - wb) x (x - ca) + wb x (cb -
//        ca)
//      (here "x" between vectors is the cross product and c the reference points), so its speed is
//      at most |va - vb| + |wa - wb| max |x - ca| + |wb| max |cb - ca|; likewise with a and b
//      exchanged. That is the better bound where both bodies turn alike. The gap is the same seen
//      from anywhere, so the smaller of the two counts. |cb - ca| is convex in t: its maximum is at
//      an end of the motion.
// The gap of two spheres changes by no more than any of these. All terms are rounded up.
class GapRate {
 public:
  GapRate(const SphereTree& a, const Motion& motion_a, const SphereTree& b, const Motion& motion_b)
      : GapRate(a.reach(), motion_a, b.reach(), motion_b) {}

  // Of bodies that reach so far from the origins of their frames; infinity for an unbounded one.
  GapRate(double reach_a, const Motion& motion_a, double reach_b, const Motion& motion_b)
      : sides_{Side(motion_a), Side(motion_b)},
        straight_(distance_upper(motion_a.displacement(), motion_b.displacement())) {
    const Eigen::Vector3d start = motion_a.anchor() - motion_b.anchor();
    const Eigen::Vector3d way = motion_a.displacement() - motion_b.displacement();
    const double anchors = motion_a.anchor_error() + motion_b.anchor_error();
    // Sums and differences err by 1 u of the terms, which the distance of the anchors and twice the
    // way bound.
    const double apart = std::max(norm_upper(start), norm_upper(start + way)) + anchors +
                         8.0 * kUnitRoundoff * (norm_upper(start) + norm_upper(way));
    const double wa = sides_[0].speed;
    const double wb = sides_[1].speed;
    // Axes have a length of 1 +- 4 u.
    const double turn =
        distance_upper(motion_a.angle() * motion_a.axis(), motion_b.angle() * motion_b.axis()) +
        8.0 * kUnitRoundoff * (wa + wb);
    const double as_one = std::min(turn * sides_[0].radius_of(reach_a) + wb * apart,
                                   turn * sides_[1].radius_of(reach_b) + wa * apart);
    together_ = (straight_ + as_one) * kUp;
    // pose_at() places the frames no farther apart than the reference points with both arms.
    const double reference_arms =
        norm_upper(motion_a.reference()) + norm_upper(motion_b.reference());
    farthest_frames_ = (apart + reference_arms) * kUp;
  }

  // Upper bound of the distance of the origins of the two bodies' frames, at any t.
  double farthest_frames() const { return farthest_frames_; }

  // No two spheres below these two nodes approach by more than this in a time `tau` (as a part of
  // the whole motion).
  double approach(const Sphere& node_a, const Sphere& node_b, double tau) const {
    const double rho_a = sides_[0].rho(node_a.center) + node_a.radius;
    const double rho_b = sides_[1].rho(node_b.center) + node_b.radius;
    const double turning = sides_[0].speed * rho_a + sides_[1].speed * rho_b;
    const double circles = 2.0 * (sides_[0].circle(rho_a) + sides_[1].circle(rho_b));
    const double apart = straight_ * tau + std::min(turning * tau, circles);
    return std::min(apart, together_ * tau) * kUp;
  }

  // Nor do any two points of the bodies, of which one may be unbounded.
  double approach(double tau) const { return together_ * tau * kUp; }

  // A time in which two spheres with these centres do not use up a gap > 0. Huge where nothing
  // moves: no divisor is zero, for every upper bound of a norm is positive.
  double free_time(const Eigen::Vector3d& center_a, const Eigen::Vector3d& center_b,
                   double gap) const {
    const double rho_a = sides_[0].rho(center_a);
    const double rho_b = sides_[1].rho(center_b);
    const double rate = straight_ + (sides_[0].speed * rho_a + sides_[1].speed * rho_b);
    const double circles = 2.0 * (sides_[0].circle(rho_a) + sides_[1].circle(rho_b)) * kUp;
    const double time = std::max(gap / (rate * kUp), gap / together_);
    return std::max(time, (gap - circles) / (straight_ * kUp)) * kDown;
  }

 private:
  // Fewer than a dozen roundings of positive terms.
  static constexpr double kUp = 1.0 + 16.0 * kUnitRoundoff;
  static constexpr double kDown = 1.0 - 64.0 * kUnitRoundoff;

  // One turning body.
  struct Side {
    explicit Side(const Motion& motion)
        : speed(std::abs(motion.angle())),
          reference(motion.reference()),
          axis(motion.start().matrix().transpose() * motion.axis()) {}

    // Upper bound of the distance of a point of the body from its axis. The axis in the body's
    // frame errs by 4 u in length and, mapped, by 18 u (Pose::operator*); the difference by 1 u, a
    // cross product by 3.5 u: less than 28 u of the distance from the reference point.
    double rho(const Eigen::Vector3d& point) const {
      if (speed == 0.0) return 0.0;
      const Eigen::Vector3d arm = point - reference;
      return norm_upper(arm.cross(axis)) +
             40.0 * kUnitRoundoff * (std::abs(arm.x()) + std::abs(arm.y()) + std::abs(arm.z()));
    }

    // What turning can move, or nothing for a body that does not turn.
    double circle(double rho) const { return speed == 0.0 ? 0.0 : rho; }

    // Upper bound of the distance of any point from the reference point: for trees the same for all
    // over the same spheres.
    double radius_of(double reach) const { return reach + norm_upper(reference); }

    double speed;
    Eigen::Vector3d reference;
    Eigen::Vector3d axis;
  };

  Side sides_[2];
  double straight_;
  double together_;
  double farthest_frames_;
};

}  // namespace spherule::internal
