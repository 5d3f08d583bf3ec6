// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres in rational numbers, and in floating-point numbers of 100 digits where a root is needed:
// an oracle that shares no code with the library.

#include "geometry/sphere.h"
#include "tests/support/exact/poses.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <optional>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;
using Real = boost::multiprecision::cpp_bin_float_100;

inline Rational exact_squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return squared_distance(exact<Rational>(a), exact<Rational>(b));
}
inline Real exact_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return sqrt(squared_distance(exact<Real>(a), exact<Real>(b)));
}

// Nearly all comparisons are clear in long double, whose differences, squares and sums of squares
// of doubles are right but for 8 x 2^-64 of themselves.
inline std::optional<bool> is_clearly_at_most(long double x, long double y) {
  constexpr long double kSlack = 0x1p-58L;
  if (x * (1.0L + kSlack) <= y * (1.0L - kSlack)) return true;
  if (x * (1.0L - kSlack) > y * (1.0L + kSlack)) return false;
  return {};
}

inline long double rough_squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.cast<long double>() - b.cast<long double>()).squaredNorm();
}

// |c_o - c_i| + r_i <= r_o, without the root.
inline bool encloses_exactly(const Sphere& outer, const Sphere& inner) {
  const long double rough_room = static_cast<long double>(outer.radius) - inner.radius;
  if (rough_room < 0.0L) return false;  // the sign is right
  const std::optional<bool> clear = is_clearly_at_most(
      rough_squared_distance(outer.center, inner.center), rough_room * rough_room);
  if (clear) return *clear;
  const Rational room = Rational(outer.radius) - Rational(inner.radius);
  return room >= 0 && exact_squared_distance(outer.center, inner.center) <= room * room;
}

// The closed spheres share a point: |c_a - c_b| <= r_a + r_b.
inline bool overlap_exactly(const Sphere& a, const Sphere& b) {
  const long double rough_sum = static_cast<long double>(a.radius) + b.radius;
  const std::optional<bool> clear =
      is_clearly_at_most(rough_squared_distance(a.center, b.center), rough_sum * rough_sum);
  if (clear) return *clear;
  const Rational sum = Rational(a.radius) + Rational(b.radius);
  return exact_squared_distance(a.center, b.center) <= sum * sum;
}

// Two placed spheres.
struct PlacedSphereSets {
  Sphere a, b;
  Pose world_from_a, world_from_b;

  template <class Number>
  Number squared_center_distance() const {
    return squared_distance(transform(world_from_a, exact<Number>(a.center)),
                            transform(world_from_b, exact<Number>(b.center)));
  }

  Real center_distance() const { return sqrt(squared_center_distance<Real>()); }

  // Negative where the spheres overlap.
  Real gap() const { return center_distance() - a.radius - b.radius; }

  // Whether the closed spheres share a point, in exact arithmetic.
  bool overlap() const {
    const Rational sum = Rational(a.radius) + Rational(b.radius);
    return squared_center_distance<Rational>() <= sum * sum;
  }
};

}  // namespace spherule::test
