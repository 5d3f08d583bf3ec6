// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do two sets of spheres, rigidly placed, overlap?
//
// @code{.cpp}
// #include <spherule/collide/collide.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// //
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const auto beside = spherule::Pose::from_translation({3.5, 0, 0});
// assert(collides(tree, {}, tree, beside));
// const spherule::CollisionResult result = collide(tree, {}, tree, beside);
// assert(result.pairs.size() == 1 && result.pairs[0].a == 1 && result.pairs[0].b == 0);
// @endcode

#include "collide/search/query.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>

namespace spherule {

// Whether two sets of spheres, rigidly placed, overlap: by simultaneous traversal of both trees
// (Gottschalk, Lin and Manocha, "OBBTree", 1996).
//
// G4 (docs/guarantee.md): if two spheres overlap (touching included) in exact arithmetic under
// exactly the given poses, the answer is true. G5: if it is true, the exact gap of the two sets is
// at most collision_slack(): the price of rounding, about 2e-14 of the size of the scene, which is
// the reach of both sets and the distance of their frames. Does not throw, and does not allocate on
// trees that build_tree() makes of up to a million spheres; for deeper ones, which only a file or
// more spheres can bring, the stack may come from the heap.
bool collides(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
              const Pose& world_from_b) noexcept;

// Whether two sets of spheres touch, by the test of collides(), with the pairs of spheres that do,
// up to the limits requested, and the cost of the search.
CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const CollisionRequest& request = {});

// The test that all of the above rest on, for one sphere of each set (indices into spheres()).
bool spheres_touch(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                   const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b) noexcept;

// Upper bound of the exact gap between two sets for which collides() answers true.
double collision_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                       const Pose& world_from_b) noexcept;

// The separation distance of two sets of spheres, between proved bounds.
//
// @code{.cpp}
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const auto apart = spherule::Pose::from_translation({7, 0, 0});
// const spherule::DistanceResult found = distance(tree, {}, tree, apart);
// assert(found.lower <= 3.0 && 3.0 <= found.upper && found.upper < 3.001);
// @endcode

// Separation distance of two sets of spheres, rigidly placed, between certified bounds.
DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const DistanceRequest& request = {});

// Do two sets of spheres come within a clearance of each other?
//
// @code{.cpp}
//
// const auto tree = spherule::build_tree(std::vector<spherule::Sphere>{{{0, 0, 0}, 1}});
// const auto apart = spherule::Pose::from_translation({3, 0, 0});
// assert(within(tree, {}, tree, apart, 1.0));
// assert(!within(tree, {}, tree, apart, 0.999));
// @endcode

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
