// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/motion_track.h"

namespace spherule {
namespace {

template <class Number>
using Point = std::array<Number, 3>;

template <class Number>
Point<Number> point(const Eigen::Vector3d& p) {
  return {Number(p.x()), Number(p.y()), Number(p.z())};
}

template <class Number>
Point<Number> cross(const Point<Number>& a, const Point<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Number dot(const Point<Number>& a, const Point<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// q v conjugate(q) / |q|^2.
template <class Number>
Point<Number> turned(const Eigen::Quaterniond& q, const Point<Number>& v) {
  const Number w = q.w();
  const Point<Number> u = {Number(q.x()), Number(q.y()), Number(q.z())};
  const Number n = w * w + dot(u, u);
  const Point<Number> once = cross(u, v);
  const Point<Number> twice = cross(u, once);
  Point<Number> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = v[k] + 2 * (w * once[k] + twice[k]) / n;
  return result;
}

template <class Number>
Point<Number> image(const Pose& pose, const Eigen::Vector3d& p) {
  Point<Number> result = turned(pose.rotation(), point<Number>(p));
  for (std::size_t k = 0; k < 3; ++k) result[k] += pose.translation()[static_cast<int>(k)];
  return result;
}

}  // namespace

template <class Number>
void MotionTrack<Number>::add_spheres(std::span<const Sphere> spheres, const Pose& start,
                                      const Point& axis, const Eigen::Vector3d& reference,
                                      double extent) {
  const Point anchor = image<Number>(start, reference);
  const Point c = point<Number>(reference);
  for (const Sphere& sphere : spheres) {
    const Point p = point<Number>(sphere.center);
    const Point from = turned(start.rotation(), Point{p[0] - c[0], p[1] - c[1], p[2] - c[2]});
    const Number along = dot(axis, from);
    TrackedSphere tracked{};
    for (std::size_t k = 0; k < 3; ++k) {
      tracked.base[k] = anchor[k] + along * axis[k];
      tracked.arm[k] = from[k] - along * axis[k];
    }
    tracked.side = cross(axis, from);
    tracked.radius = sphere.radius;
    tracked.extent = (extent + sphere.center.template lpNorm<1>() +
                      2.0 * reference.template lpNorm<1>() + sphere.radius) *
                     (1 + 1e-9);
    spheres_.push_back(tracked);
  }
  set_errors();
}

template <class Number>
MotionTrack<Number> MotionTrack<Number>::turning(std::span<const Sphere> spheres, const Pose& start,
                                                 const Eigen::Vector3d& axis, double angle,
                                                 const Eigen::Vector3d& displacement,
                                                 const Eigen::Vector3d& reference) {
  MotionTrack track;
  track.angle_ = angle;
  track.way_ = point<Number>(displacement);
  Point unit = point<Number>(axis);
  const Number length = std::sqrt(dot(unit, unit));
  for (Number& x : unit) x /= length;
  track.add_spheres(spheres, start, unit, reference,
                    start.translation().lpNorm<1>() + displacement.lpNorm<1>());
  return track;
}

template <class Number>
MotionTrack<Number> MotionTrack<Number>::between(std::span<const Sphere> spheres, const Pose& start,
                                                 const Pose& end,
                                                 const Eigen::Vector3d& reference) {
  MotionTrack track;
  const Point first = image<Number>(start, reference), last = image<Number>(end, reference);
  for (std::size_t k = 0; k < 3; ++k) track.way_[k] = last[k] - first[k];
  // The quotient end / start, of no particular length.
  const Eigen::Quaterniond a = end.rotation(), b = start.rotation();
  const Number aw = a.w(), bw = b.w();
  const Point av = point<Number>(a.vec()), bv = point<Number>(b.vec());
  Number w = aw * bw + dot(av, bv);
  const Point across = cross(bv, av);
  Point v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = av[k] * bw - aw * bv[k] + across[k];
  if (w < 0) {
    w = -w;
    for (Number& x : v) x = -x;
  }
  const Number sine = std::sqrt(dot(v, v));
  track.angle_ = 2 * std::atan2(sine, w);
  Point axis{0, 0, 1};
  if (sine > 0) axis = {v[0] / sine, v[1] / sine, v[2] / sine};
  track.add_spheres(spheres, start, axis, reference,
                    2.0 * (start.translation().lpNorm<1>() + end.translation().lpNorm<1>()));
  return track;
}

template class MotionTrack<long double>;

}  // namespace spherule
