// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Rigid motions in time.
//
// @code{.cpp}
// #include <spherule/collide/motion/motion.h>
// #include <cassert>
// #include <cmath>
//
// const spherule::Pose start;
// const spherule::Pose end({0, 0, 0, 1}, {0, 0, 1});  // half a turn about z, and 1 up
// const auto motion = spherule::Motion::between(start, end);
// const Eigen::Vector3d middle = motion.pose_at(0.5) * Eigen::Vector3d(1, 0, 0);
// assert(std::abs(middle.z() - 0.5) < 1e-12 && std::abs(middle.x()) < 1e-12);
// @endcode

#include "geometry/pose.h"

namespace spherule {

// A rigid motion over t in [0, 1]: a reference point of the body goes straight at constant speed,
// while the body turns about it at constant speed about an axis that is fixed in the world. Of a
// point p of the body, with the start pose (R0, t0), the reference point c, the displacement v, the
// axis n and the angle phi:
//     x(t) = Rot(n, t phi) R0 (p - c) + (R0 c + t0) + t v.
// This is the motion that promises are about, in exact arithmetic; pose_at() is a rounded image.
class Motion {
 public:
  // The largest |angle| in radians, more than 160,000 turns.
  static constexpr double kLargestAngle = 0x1p20;

  // Stands still.
  static Motion still(const Pose& world_from_body);

  // From pose to pose by the shorter way round; where both ways are equally long to rounding, by
  // either of the two. It starts and ends at exactly the given poses. `reference` is in the body's
  // frame. Throws Error for numbers that are not finite and for a motion that could take the body's
  // origin or the reference point beyond kMaxCoordinate.
  static Motion between(const Pose& start, const Pose& end,
                        const Eigen::Vector3d& reference = Eigen::Vector3d::Zero());

  // Turns by `angle` (radians, of any size up to kLargestAngle) about `axis` (in the world's frame,
  // of any length) through the reference point, which moves by `displacement`. Throws Error as
  // between() does, for a zero axis, and for an angle beyond kLargestAngle.
  static Motion turning(const Pose& start, const Eigen::Vector3d& axis, double angle,
                        const Eigen::Vector3d& displacement = Eigen::Vector3d::Zero(),
                        const Eigen::Vector3d& reference = Eigen::Vector3d::Zero());

  // Exactly the start at 0 and, for between(), exactly the end at 1. Throws Error unless
  // 0 <= t <= 1.
  Pose pose_at(double t) const;

  // Upper bound of the distance between the place of a point under pose_at(t) and under the motion,
  // for every t and every point within `reach` of the origin of the body's frame.
  double pose_error(double reach) const;

  // The motion described above by numbers that are exact, up to the error of pose_error(): the axis
  // has a length of 1 within 4 units of 2^-53; the angle is not negative for between().
  const Pose& start() const { return start_; }
  const Eigen::Vector3d& reference() const { return reference_; }
  const Eigen::Vector3d& displacement() const { return displacement_; }
  const Eigen::Vector3d& axis() const { return axis_; }
  double angle() const { return angle_; }

  // Where the reference point starts, within anchor_error().
  const Eigen::Vector3d& anchor() const { return anchor_; }
  double anchor_error() const;

 private:
  Motion(const Pose& start, const Pose& end, const Eigen::Vector3d& reference);
  bool is_static() const { return angle_ == 0.0 && displacement_.isZero(0.0); }

  Pose start_;
  Pose end_;
  bool ends_at_end_ = false;
  Eigen::Vector3d reference_;
  Eigen::Vector3d anchor_;
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  double angle_ = 0.0;
  // Between the motion of the exact numbers above and the one that was requested, at any t: the
  // angle of the rotation that takes one to the other, and the distance of the reference points.
  double drift_angle_ = 0.0;
  double drift_offset_ = 0.0;
};

}  // namespace spherule
