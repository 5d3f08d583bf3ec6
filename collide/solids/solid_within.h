// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do meshes with their insides, or such a mesh and a primitive, come within a clearance?
//
// @code{.cpp}
// #include <spherule/collide/solids/solid_within.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::SolidMesh solid(tetrahedron);
// const auto beside = spherule::Pose::from_translation({1.5, 0, 0});
// assert(!within(solid, {}, solid, beside, 0.0));
// assert(within(solid, {}, solid, beside, 0.5));
// assert(within(solid, {}, spherule::SolidSphere{.radius = 0.5}, beside, 0.0));
// @endcode

#include "collide/meshes/solid_mesh.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"

namespace spherule {

// Whether two meshes with their insides, rigidly placed, come within a clearance of each other; of
// 0 whether they have a point in common. inflation() of both counts.
//
// Never false if the exact distance under exactly the given poses is at most the clearance. If it
// is true, the exact one is larger by rounding only: some units in the last place of the scene, and
// up to about 1e-8 of the longest edge where corners of needles are nearest to each other
// (geometry/triangles.h). Inside is what SolidMesh says. Allocates as collides() of two
// trees does. Throws Error as require_clearance() does.
bool within(const SolidMesh& a, const Pose& world_from_a, const SolidMesh& b,
            const Pose& world_from_b, double clearance);

// Whether a mesh with its inside and a solid of simple shape, rigidly placed, come within a
// clearance of each other. Never false if the exact distance is at most the clearance. If it is
// true, the exact distance is larger by at most 1e-9 of the scene, or by more where a triangle lies
// along a curved surface at nearly that distance and the search for a proof was given up.
bool within(const SolidMesh& a, const Pose& world_from_a, const Primitive& b,
            const Pose& world_from_b, double clearance);

}  // namespace spherule
