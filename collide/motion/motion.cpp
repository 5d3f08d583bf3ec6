// SPDX-License-Identifier: BSD-3-Clause
#include "collide/motion/motion.h"

#include "base/error.h"
#include "base/rounding.h"

#include <cmath>

// The error budget of motions, u = 2^-53. The stored start, reference c, displacement v, axis n and
// angle phi define an exact motion, the stored one. What was requested differs from it by the
// drift, and pose_at() from it by rounding. Unit quaternions that are e apart belong to rotations
// whose quotient turns by 2 asin(e / 2) * 2 = 2 e, to first order; a rotation by a small angle
// moves a point by no more than the angle times its distance from a fixed point.
//
// Rotation of pose_at(). The C library's sine and cosine are taken to err by at most 4 units in the
// last place (the usual ones stay below 1), 8 u each, 11.4 u together; half the angle t phi / 2
// errs by u |phi| / 2; the axis has a length of 1 +- 4 u, and each product with it 1 u: 5 u; the
// start's rotation made unit 2 u; the product of two unit quaternions, four products and three sums
// a component, 8 u. Together 26.4 u + u |phi| / 2 as quaternions, as an angle less than
//     kTurnError + 2 u |phi|,   kTurnError = 64 u.
//
// Translation of pose_at(). A mapped vector errs by 18 u |c| (Pose::operator*). The anchor R0 c +
// t0: 18 u |c| + u (|c| + |t0|). The reference point, anchor + t v: u |v| more for the product and
// u (|c| + |t0| + |v|) for the sum. Minus R c: 18 u |c| and u (2 |c| + |t0| + |v|). Together 40 u
// |c| + 3 u |t0| + 3 u |v|: less than kArm |c| + kPlace (|t0| + |v|). For a motion without turn the
// translation is t0 + t v, well within that.
//
// Drift of turning(): the axis made unit is 1 u away from the one given, by its divisions (what
// they have in common changes no direction). Turning about axes that are e apart leaves quaternions
// at most e apart: an angle of 2 u, for which kAxisDrift = 8 u stands.
//
// Drift of between(). The quotient of the two rotations, as quaternions, errs by 2 u + 2 u + 8 u;
// its axis by 2 u; its half angle atan2(|vector|, w), in [0, pi/2 + 12 u], by 1.25 u for the norm
// and 8 u for the library (4 units in the last place): with exact numbers in between, the stored
// end is less than 24 u away from the exact one. The logarithm of unit quaternions with half angles
// up to pi/2 stretches distances by at most pi/2 (theta / sin theta), the exponential by at most 1,
// so at any t the stored rotation is at most 1.58 * 24 u < 38 u away as a quaternion and less than
// kBetweenDrift = 128 u as an angle. A quotient so near to the identity that its vector is below
// 2^-500 is stored as no turn. The displacement, the difference of two anchors, errs by less than
// kArm |c| + kPlace (|t0| + |t1|).

namespace spherule {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kTurnError = 64.0 * kUnitRoundoff;
constexpr double kAxisDrift = 8.0 * kUnitRoundoff;
constexpr double kBetweenDrift = 128.0 * kUnitRoundoff;
constexpr double kArm = 48.0 * kUnitRoundoff;
constexpr double kPlace = 4.0 * kUnitRoundoff;

// Throws unless the reference point and the body's origin stay within kMaxCoordinate.
void check_extent(const Pose& start, const Vector3d& reference, const Vector3d& displacement) {
  if (!is_usable_point(reference)) {
    throw Error("motion", "the reference point is not finite or exceeds 1e15");
  }
  if (!is_usable_point(displacement)) {
    throw Error("motion", "the displacement is not finite or exceeds 1e15");
  }
  const double extent =
      start.translation().lpNorm<1>() + 2.0 * reference.lpNorm<1>() + displacement.lpNorm<1>();
  // A little less than the limit, so that rounding does not carry a pose beyond it.
  if (!(extent <= kMaxCoordinate * (1.0 - 1e-12))) {
    throw Error("motion", "it may lead farther than 1e15 from the origin");
  }
}

Vector3d anchor_of(const Pose& pose, const Vector3d& reference) {
  return reference.isZero(0.0) ? pose.translation() : Vector3d(pose * reference);
}

}  // namespace

Motion::Motion(const Pose& start, const Pose& end, const Vector3d& reference)
    : start_(start), end_(end), reference_(reference), anchor_(anchor_of(start, reference)) {}

Motion Motion::still(const Pose& world_from_body) {
  return Motion(world_from_body, world_from_body, Vector3d::Zero());
}

Motion Motion::between(const Pose& start, const Pose& end, const Vector3d& reference) {
  check_extent(start, reference, Vector3d::Zero());
  check_extent(end, reference, Vector3d::Zero());
  Motion motion(start, end, reference);
  motion.ends_at_end_ = true;

  const Quaterniond first = start.rotation();
  const Quaterniond last = end.rotation();
  const bool parallel = first.coeffs() == last.coeffs() || first.coeffs() == -last.coeffs();
  if (!parallel) {
    Quaterniond quotient = unit_rotation(last) * unit_rotation(first).conjugate();
    if (quotient.w() < 0.0) quotient.coeffs() = -quotient.coeffs();
    const double sine = quotient.vec().norm();
    if (sine >= 0x1p-500) {
      motion.angle_ = 2.0 * std::atan2(sine, quotient.w());
      motion.axis_ = quotient.vec() / sine;
    }
    motion.drift_angle_ = kBetweenDrift;
  }

  const bool in_place = parallel && start.translation() == end.translation();
  if (!in_place) {
    motion.displacement_ = anchor_of(end, reference) - motion.anchor_;
    const double places = norm_upper(start.translation()) + norm_upper(end.translation());
    motion.drift_offset_ =
        (kArm * norm_upper(reference) + kPlace * places) * kRelativeUp + kUnderflow;
  }
  return motion;
}

Motion Motion::turning(const Pose& start, const Vector3d& axis, double angle,
                       const Vector3d& displacement, const Vector3d& reference) {
  check_extent(start, reference, displacement);
  if (!(std::abs(angle) <= kLargestAngle)) {
    throw Error("motion", "the angle is not finite or exceeds 2^20");
  }
  const double scale = axis.cwiseAbs().maxCoeff();
  if (!axis.allFinite() || !(scale > 0.0)) {
    throw Error("motion", "the axis is not finite or zero");
  }
  Motion motion(start, start, reference);
  motion.displacement_ = displacement;
  motion.angle_ = angle;
  // By a power of two, which is exact; underflow of what is far smaller than the largest is not
  // noticed by the direction.
  int exponent = 0;
  std::frexp(scale, &exponent);
  const Vector3d scaled(std::ldexp(axis.x(), -exponent), std::ldexp(axis.y(), -exponent),
                        std::ldexp(axis.z(), -exponent));
  motion.axis_ = scaled / scaled.norm();
  motion.drift_angle_ = angle == 0.0 ? 0.0 : kAxisDrift;
  return motion;
}

Pose Motion::pose_at(double t) const {
  if (!(t >= 0.0 && t <= 1.0)) throw Error("motion", "the time is not in [0, 1]");
  if (t == 1.0 && ends_at_end_) return end_;
  if (t == 0.0 || is_static()) return start_;
  if (angle_ == 0.0) return Pose(start_.rotation(), start_.translation() + t * displacement_);

  const double half = 0.5 * (t * angle_);
  const double sine = std::sin(half);
  const Quaterniond turn(std::cos(half), axis_.x() * sine, axis_.y() * sine, axis_.z() * sine);
  const Quaterniond rotation = turn * unit_rotation(start_.rotation());
  const Vector3d place = anchor_ + t * displacement_;
  if (reference_.isZero(0.0)) return Pose(rotation, place);
  const Pose about_reference(rotation, Vector3d::Zero());
  return Pose(rotation, place - about_reference * reference_);
}

double Motion::pose_error(double reach) const {
  if (is_static() && drift_angle_ == 0.0) return drift_offset_;
  const double arm = norm_upper(reference_);
  const double of_pose = angle_ == 0.0 ? 0.0 : kTurnError + 2.0 * kUnitRoundoff * std::abs(angle_);
  const double turned = (of_pose + drift_angle_) * (reach + arm);
  const double places = norm_upper(start_.translation()) + norm_upper(displacement_);
  // Fewer than a dozen roundings of positive terms.
  return (turned + (kArm * arm + kPlace * places) + drift_offset_) * (1.0 + 16.0 * kUnitRoundoff) +
         kUnderflow;
}

double Motion::anchor_error() const {
  if (reference_.isZero(0.0)) return 0.0;
  return (20.0 * kUnitRoundoff * norm_upper(reference_) +
          2.0 * kUnitRoundoff * norm_upper(start_.translation())) *
             kRelativeUp +
         kUnderflow;
}

}  // namespace spherule
