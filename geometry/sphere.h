// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres, predicates that err on one side only, and enclosing spheres.
//
// @code{.cpp}
// #include <spherule/geometry/sphere.h>
// #include <cassert>
//
// const spherule::Sphere a{{0, 0, 0}, 1.0};
// const spherule::Sphere b{{2, 0, 0}, 1.0};
// assert(possibly_overlap(a, b));  // they touch
// assert(!certainly_encloses(a, b));
// assert(certainly_contains(a, {0.5, 0, 0}));
// @endcode

#include "base/rounding.h"

#include <Eigen/Core>

#include <span>

namespace spherule {

// A closed sphere, in the unit of the model. The numbers are exact: every promise of the library is
// about the sphere with exactly these doubles.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// Equal numbers.
inline bool operator==(const Sphere& a, const Sphere& b) {
  return a.center == b.center && a.radius == b.radius;
}

// True if the numbers can be used: finite, not absurdly large, the radius not negative.
inline bool is_usable(const Sphere& s) {
  return is_usable_point(s.center) && s.radius >= 0.0 && s.radius <= kMaxCoordinate;
}

// The predicates are padded (base/rounding.h): "certainly" is never wrong and may say no
// within a few units in the last place of the limit; "possibly" is the reverse.

// True only if the sphere `inner` is a subset of the sphere `outer` in exact arithmetic.
inline bool certainly_encloses(const Sphere& outer, const Sphere& inner) {
  return add_up(distance_upper(outer.center, inner.center), inner.radius) <= outer.radius;
}

// True only if the sphere of radius `reach` about `point` is a subset of `sphere` in exact
// arithmetic.
inline bool certainly_contains(const Sphere& sphere, const Eigen::Vector3d& point,
                               double reach = 0.0) {
  return add_up(distance_upper(sphere.center, point), reach) <= sphere.radius;
}

// False only if the two closed spheres are disjoint in exact arithmetic.
inline bool possibly_overlap(const Sphere& a, const Sphere& b) {
  return distance_lower(a.center, b.center) <= add_up(a.radius, b.radius);
}

// Smallest enclosing spheres, rounded up.
//
// @code{.cpp}
// #include <vector>
//
// const std::vector<Eigen::Vector3d> points{{-1, 0, 0}, {1, 0, 0}, {0, 0.5, 0}};
// const spherule::Sphere sphere = spherule::enclosing_sphere(points);
// for (const Eigen::Vector3d& point : points) assert(certainly_contains(sphere, point));
// assert(sphere.radius < 1.0 + 1e-12);
// @endcode

// The smallest sphere that encloses all points, or all spheres, up to rounding (Fischer and
// Gaertner, "The smallest enclosing ball of balls", 2003): its radius is rounded up so that it
// encloses them in exact arithmetic (certainly_encloses() or certainly_contains() holds for each).
// The input must not be empty.
Sphere enclosing_sphere(std::span<const Eigen::Vector3d> points);
Sphere enclosing_sphere(std::span<const Sphere> spheres);

}  // namespace spherule
