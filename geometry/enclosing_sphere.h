// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Smallest enclosing spheres, rounded up.
//
// @code{.cpp}
// #include <spherule/geometry/enclosing_sphere.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<Eigen::Vector3d> points{{-1, 0, 0}, {1, 0, 0}, {0, 0.5, 0}};
// const spherule::Sphere sphere = spherule::enclosing_sphere(points);
// for (const Eigen::Vector3d& point : points) assert(certainly_contains(sphere, point));
// assert(sphere.radius < 1.0 + 1e-12);
// @endcode

#include "geometry/sphere.h"

#include <span>

namespace spherule {

// The smallest sphere that encloses all points, or all spheres, up to rounding (Fischer and
// Gaertner, "The smallest enclosing ball of balls", 2003): its radius is rounded up so that it
// encloses them in exact arithmetic (certainly_encloses() or certainly_contains() holds for each).
// The input must not be empty.
Sphere enclosing_sphere(std::span<const Eigen::Vector3d> points);
Sphere enclosing_sphere(std::span<const Sphere> spheres);

}  // namespace spherule
