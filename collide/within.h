// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do two sets of spheres come within a clearance of each other?
//
// @code{.cpp}
// #include <spherule/collide/within.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const auto tree = spherule::build_tree(std::vector<spherule::Sphere>{{{0, 0, 0}, 1}});
// const auto apart = spherule::Pose::from_translation({3, 0, 0});
// assert(within(tree, {}, tree, apart, 1.0));
// assert(!within(tree, {}, tree, apart, 0.999));
// @endcode

#include "collide/collide.h"

namespace spherule {

// Throws Error for a number that is no clearance: negative, not a number, or beyond 1e15.
void require_clearance(double clearance);

// Whether two sets of spheres, rigidly placed, come within a clearance (at least 0) of each other:
// collides() for sets that keep a margin, and the same for a clearance of 0.
//
// Never false if the exact gap is at most the clearance, under exactly the given poses; never true
// if it exceeds the clearance by more than within_slack(). One canonical test of two spheres
// decides, so the answer depends neither on the trees nor on the order of the arguments. Allocates
// as collides() does. Throws Error as require_clearance() does.
bool within(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
            const Pose& world_from_b, double clearance);

// The canonical test of within() for one sphere of each set (indices into spheres()).
bool spheres_within(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                    const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b,
                    double clearance);

// Upper bound of what the exact gap of two sets may exceed the clearance by where within() answers
// true: collision_slack() and 16 units of 2^-53 of the clearance.
double within_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                    const Pose& world_from_b, double clearance);

}  // namespace spherule
