// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"

#include <Eigen/Core>

#include <cmath>

namespace spherule::internal {

// How far spheres of the cover reach along the boundary of S, by which a search may be coarser
// where they are large. Plain double: this serves searches, never a proof.

// Half the width of what a sphere of radius `inside` + E covers of a plane that cuts off its last
// E: a sphere of S of radius `inside` that touches the plane, grown by E. At a convex edge, which
// such a sphere can only touch with radius 0, it covers about E.
inline double cap_width(double inside, double max_error) {
  return std::sqrt(max_error * (max_error + 2.0 * inside));
}

// Wider caps, as multiples of E, are not told apart: rows as far from each other as this allows are
// few enough.
inline constexpr double kWidestCap = 30.0;

// The inverse of cap_width, for a width of at least E.
inline double inside_radius(double width, double max_error) {
  return (width * width / max_error - max_error) / 2.0;
}

// Whether a sphere of S of radius `inside` touches the boundary of S, up to a share of E, where the
// clearance at `point` is measured to, given as `at`.
bool touched_by(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                double inside, double max_error);

// The greatest cap_width of the spheres that touch there, to a factor of 1.4; no more than
// kWidestCap times E.
double cap_width_at(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                    double max_error);

}  // namespace spherule::internal
