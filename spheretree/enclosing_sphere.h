// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <span>

namespace spherule {

// The smallest sphere that encloses all points, or all spheres, its radius rounded up so that it
// encloses them in exact arithmetic (certainly_encloses holds for each). The input must not be
// empty.
Sphere enclosing_sphere(std::span<const Eigen::Vector3d> points);
Sphere enclosing_sphere(std::span<const Sphere> spheres);

}  // namespace spherule
