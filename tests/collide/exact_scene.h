// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Oracle of the tests in this folder, which shares no code with the library: poses and spheres in
// rational numbers, and in floating-point numbers of 100 digits where a root is needed. These are
// slow to compile; exact_pose.h and scene_random.h go without them.

#include "geometry/sphere.h"
#include "tests/collide/exact_pose.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;
using Real = boost::multiprecision::cpp_bin_float_100;

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
