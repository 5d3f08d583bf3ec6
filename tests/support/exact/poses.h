// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What poses and motions do to points, in whatever numbers a test needs. Nothing here shares code
// with the library: the rotation of q / norm(q) is rational in the components of q, and a motion is
// the formula of collide/motion/motion.h. Without Boost, which is slow to compile.

#include "geometry/pose.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace spherule::test {

template <class Number>
using Vector = std::array<Number, 3>;

// Image of `p` under exactly the rotation of q / norm(q) and the translation.
template <class Number>
Vector<Number> transform(const Pose& pose, const Vector<Number>& p) {
  const Number w = pose.rotation().w();
  const Number x = pose.rotation().x();
  const Number y = pose.rotation().y();
  const Number z = pose.rotation().z();
  const Number ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Number n = ww + xx + yy + zz;
  const auto& t = pose.translation();
  return {
      ((ww + xx - yy - zz) * p[0] + 2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2]) / n +
          t.x(),
      (2 * (x * y + w * z) * p[0] + (ww - xx + yy - zz) * p[1] + 2 * (y * z - w * x) * p[2]) / n +
          t.y(),
      (2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] + (ww - xx - yy + zz) * p[2]) / n +
          t.z()};
}

template <class Number>
Vector<Number> exact(const Eigen::Vector3d& p) {
  return {Number(p.x()), Number(p.y()), Number(p.z())};
}

template <class Number>
Number squared_distance(const Vector<Number>& a, const Vector<Number>& b) {
  const Number x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

template <class Number>
Vector<Number> difference(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Vector<Number> plus(const Vector<Number>& a, const Number& factor, const Vector<Number>& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

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
    motion.displacement_ = difference(last, motion.anchor_);
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
    const Point arm = difference(placed, anchor_);
    const Number angle = t * angle_;
    const Number c = cos(angle), s = sin(angle);
    const Number along = dot(axis_, arm) * (1 - c);
    const Point side = cross(axis_, arm);
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
