// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"
#include "collide/distance.h"
#include "spheretree/pose.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <string>
#include <variant>

namespace spherule {

// Solids of a few numbers. Each is a closed set of points of its own frame, exactly: centred at the
// origin, cylinder and capsule along z.

// |x_i| <= size_i / 2 in each coordinate.
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // full edge lengths, as in URDF
};

// |x| <= radius.
struct Ball {
  double radius = 1.0;
};

// x^2 + y^2 <= radius^2 and |z| <= length / 2.
struct Cylinder {
  double radius = 1.0;
  double length = 1.0;
};

// The points within `radius` of the segment |z| <= length / 2 of the axis.
struct Capsule {
  double radius = 1.0;
  double length = 1.0;  // of the straight part
};

// z <= 0.
struct HalfSpace {};

using Primitive = std::variant<Box, Ball, Cylinder, Capsule, HalfSpace>;

// Throws Error(subject, ...) unless every size is finite, above 0 and at most kMaxCoordinate; the
// straight part of a capsule may be 0.
void require_primitive(const Primitive& primitive, const std::string& subject);

}  // namespace spherule
