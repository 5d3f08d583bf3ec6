// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres against boxes, spheres, cylinders, capsules and half-spaces.
//
// @code{.cpp}
// #include <spherule/collide/solids/primitive.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const spherule::Primitive table = spherule::Box{.size = {4, 4, 0.5}};
// const auto below = spherule::Pose::from_translation({0, 0, -1.5});
// assert(!collides(tree, {}, table, below));
// assert(within(tree, {}, table, below, 0.25));  // the gap
// assert(distance(tree, {}, spherule::HalfSpace{}, below).upper < 0.501);
// @endcode

#include "collide/search/query.h"
#include "geometry/pose.h"
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
struct SolidSphere {
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

// A solid of simple shape.
using Primitive = std::variant<Box, SolidSphere, Cylinder, Capsule, HalfSpace>;

// Throws Error(subject, ...) unless every size is finite, above 0 and at most kMaxCoordinate; the
// straight part of a capsule may be 0.
void require_primitive(const Primitive& primitive, const std::string& subject);

// In all that follows the solid must be one that require_primitive() accepts.
//
// Whether a set of spheres and a solid, rigidly placed, overlap.
//
// G4: if a sphere and the solid have a point in common in exact arithmetic under exactly the given
// poses, the answer is true. G5: if it is true, the exact distance of the two is at most
// primitive_slack(). One canonical test of a sphere and the solid decides, so the answer does not
// depend on the tree over the spheres. Does not throw, and allocates no more than collides() of two
// trees does.
bool collides(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
              const Pose& world_from_solid) noexcept;

// Whether a set of spheres and a solid overlap, by the test of collides(), with the spheres that
// do, up to the limits requested, and the cost: in a pair, `a` is the sphere and `b` is 0.
CollisionResult collide(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                        const Pose& world_from_solid, const CollisionRequest& request = {});

// Whether they come within a clearance of each other: never false if the exact distance is at most
// the clearance, never true if it exceeds it by more than primitive_slack(). Throws Error as
// require_clearance() does.
bool within(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
            const Pose& world_from_solid, double clearance);

// Their separation distance between certified bounds; in `nearest`, `b` is 0.
DistanceResult distance(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                        const Pose& world_from_solid, const DistanceRequest& request = {});

// Upper bound of what the exact distance may exceed the clearance by where within() answers true,
// and collides() for a clearance of 0: about 4e-14 of the size of the scene, which is the reach of
// the spheres in their frame, the sizes of the solid and the distance of the two frames.
double primitive_slack(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                       const Pose& world_from_solid, double clearance = 0.0);

}  // namespace spherule
