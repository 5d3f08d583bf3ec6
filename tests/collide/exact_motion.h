// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Oracle of motions, which shares no code with the library: the formula of collide/motion/motion.h
// in any floating-point type, from what the motion was made of.

#include "tests/collide/exact_pose.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace spherule::test {

template <class Number>
class ExactMotion {
 public:
  using Point = Vector<Number>;

  static ExactMotion turning(const Pose& start, const Eigen::Vector3d& axis, double angle,
                             const Eigen::Vector3d& displacement,
                             const Eigen::Vector3d& reference) {
    ExactMotion motion;
    motion.start_ = start;
    motion.reference_ = exact<Number>(reference);
    motion.displacement_ = exact<Number>(displacement);
    motion.axis_ = unit(exact<Number>(axis));
    motion.angle_ = angle;
    motion.anchor_ = transform(start, motion.reference_);
    return motion;
  }

  // By the way round that goes less than half a turn.
  static ExactMotion between(const Pose& start, const Pose& end, const Eigen::Vector3d& reference) {
    ExactMotion motion;
    motion.start_ = start;
    motion.reference_ = exact<Number>(reference);
    motion.anchor_ = transform(start, motion.reference_);
    const Point last = transform(end, motion.reference_);
    for (std::size_t i = 0; i < 3; ++i) motion.displacement_[i] = last[i] - motion.anchor_[i];
    // The quotient last * conjugate(first), not normalised.
    const auto [aw, ax, ay, az] = numbers(end.rotation());
    const auto [bw, bx, by, bz] = numbers(start.rotation().conjugate());
    Number w = aw * bw - ax * bx - ay * by - az * bz;
    Point v = {aw * bx + ax * bw + ay * bz - az * by, aw * by + ay * bw + az * bx - ax * bz,
               aw * bz + az * bw + ax * by - ay * bx};
    if (w < 0) {
      w = -w;
      for (Number& x : v) x = -x;
    }
    using std::atan2;
    using std::sqrt;
    const Number sine = sqrt(dot(v, v));
    motion.angle_ = 2 * atan2(sine, w);
    motion.axis_ = sine > 0 ? unit(v) : Point{0, 0, 1};
    return motion;
  }

  // Rodrigues' formula.
  Point at(const Number& t, const Eigen::Vector3d& p) const {
    using std::cos;
    using std::sin;
    const Point placed = transform(start_, exact<Number>(p));
    const Point arm = {placed[0] - anchor_[0], placed[1] - anchor_[1], placed[2] - anchor_[2]};
    const Number angle = t * angle_;
    const Number c = cos(angle), s = sin(angle);
    const Number along = dot(axis_, arm) * (1 - c);
    const Point side = {axis_[1] * arm[2] - axis_[2] * arm[1],
                        axis_[2] * arm[0] - axis_[0] * arm[2],
                        axis_[0] * arm[1] - axis_[1] * arm[0]};
    Point result;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = anchor_[i] + t * displacement_[i] + (arm[i] * c + side[i] * s + axis_[i] * along);
    }
    return result;
  }

 private:
  static std::array<Number, 4> numbers(const Eigen::Quaterniond& q) {
    return {Number(q.w()), Number(q.x()), Number(q.y()), Number(q.z())};
  }
  static Number dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Point unit(const Point& v) {
    using std::sqrt;
    const Number length = sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
  }

  Pose start_;
  Point reference_{}, displacement_{}, axis_{}, anchor_{};
  Number angle_ = 0;
};

}  // namespace spherule::test
