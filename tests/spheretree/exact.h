// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Exact oracles of the tests in this folder. They share no code with the library: a double is a
// rational number, and rational numbers are compared without rounding.

#include "spheretree/sphere.h"

#include <boost/multiprecision/cpp_int.hpp>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;

inline Rational squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Rational sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Rational difference = Rational(a[axis]) - Rational(b[axis]);
    sum += difference * difference;
  }
  return sum;
}

// |c_o - c_i| + r_i <= r_o, without the root.
inline bool encloses_exactly(const Sphere& outer, const Sphere& inner) {
  const Rational room = Rational(outer.radius) - Rational(inner.radius);
  return room >= 0 && squared_distance(outer.center, inner.center) <= room * room;
}

// The closed spheres share a point: |c_a - c_b| <= r_a + r_b.
inline bool overlap_exactly(const Sphere& a, const Sphere& b) {
  const Rational sum = Rational(a.radius) + Rational(b.radius);
  return squared_distance(a.center, b.center) <= sum * sum;
}

}  // namespace spherule::test
