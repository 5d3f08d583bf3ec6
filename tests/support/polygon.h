// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace spherule {

// A simple polygon, counter-clockwise, without repeated corners.
using Loop = std::vector<Eigen::Vector2d>;

// Regular polygon inscribed in a circle; the first corner at angle `phase` (radians).
Loop circle(const Eigen::Vector2d& center, double radius, int sides, double phase = 0.0);

// Axis-parallel rectangle; with a radius, each corner is an arc of `steps` chords.
Loop rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& size, double radius = 0.0,
               int steps = 4);

// Outline of two circles and their outer tangents; `steps` chords on each arc. Neither circle
// may contain the other.
Loop belt(const Eigen::Vector2d& a, double radius_a, const Eigen::Vector2d& b, double radius_b,
          int steps);

// `count` circles evenly on a ring: a flange's screw holes.
std::vector<Loop> screw_holes(const Eigen::Vector2d& center, double ring_radius, int count,
                              double hole_radius, int sides, double phase = 0.0);

// Triangles of `outer` less the `holes` (each counter-clockwise too, disjoint, strictly inside),
// counter-clockwise: corners - 2 + 2 holes of them, without new corners. Indices count the corners
// of `outer`, then those of the holes in order. Throws Error if the loops are not as described.
std::vector<Eigen::Vector3i> triangulate(const Loop& outer, const std::vector<Loop>& holes);

}  // namespace spherule
