// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Oracle of the tests in this folder, which shares no code with the library: poses and balls in
// rational numbers (the rotation of q / norm(q) is rational in the components of q), and in
// floating-point numbers of 100 digits where a root is needed.

#include "spheretree/pose.h"
#include "spheretree/sphere.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <random>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;
using Real = boost::multiprecision::cpp_bin_float_100;

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

// Two placed balls.
struct PlacedBalls {
  Sphere a, b;
  Pose world_from_a, world_from_b;

  template <class Number>
  Number squared_center_distance() const {
    return squared_distance(transform(world_from_a, exact<Number>(a.center)),
                            transform(world_from_b, exact<Number>(b.center)));
  }

  Real center_distance() const { return sqrt(squared_center_distance<Real>()); }

  // Negative where the balls overlap.
  Real gap() const { return center_distance() - a.radius - b.radius; }

  // Whether the closed balls share a point, in exact arithmetic.
  bool overlap() const {
    const Rational sum = Rational(a.radius) + Rational(b.radius);
    return squared_center_distance<Rational>() <= sum * sum;
  }
};

// Numbers from a seeded engine, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  Eigen::Vector3d point(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  // Not normalised; its length varies over many orders of magnitude.
  Eigen::Quaterniond quaternion() {
    const double length = std::ldexp(1.0, whole(-60, 60));
    return {uniform(-1.0, 1.0) * length, uniform(-1.0, 1.0) * length, uniform(-1.0, 1.0) * length,
            uniform(0.1, 1.0) * length};
  }
  Pose pose(double size) { return Pose(quaternion(), point(size)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace spherule::test
