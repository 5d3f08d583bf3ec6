// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How far convex solids are from each other, by alternating projections: nothing of it is shared
// with what the library does.

#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <vector>

namespace spherule::test {

// The nearest point of a convex solid in the world.
using Projection = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

// Of a tetrahedron with its inside, given by its corners in the world.
Projection onto_tetrahedron(const std::array<Eigen::Vector3d, 4>& corners);
Projection onto_primitive(const Primitive& solid, const Pose& world_from_solid);
Projection onto_sphere(const Eigen::Vector3d& center, double radius);

// Not below the distance; above it by little, see solid_oracle.cpp. 0 where the two overlap by more
// than that.
double distance_between(const Projection& a, const Projection& b, const Eigen::Vector3d& from);

}  // namespace spherule::test
