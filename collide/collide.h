// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do two sets of spheres, rigidly placed, overlap?
//
// @code{.cpp}
// #include <spherule/collide/collide.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const auto beside = spherule::Pose::from_translation({3.5, 0, 0});
// assert(collides(tree, {}, tree, beside));
// const spherule::CollisionResult result = collide(tree, {}, tree, beside);
// assert(result.pairs.size() == 1 && result.pairs[0].a == 1 && result.pairs[0].b == 0);
// @endcode

#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace spherule {

// What a query found; kUnknown where a limit ended it: to be taken for a collision.
enum class Verdict { kFree, kCollision, kUnknown };

// What a query cost.
struct QueryCost {
  std::uint64_t node_tests = 0;  // pairs of spheres tested, leaves included
  std::uint64_t leaf_tests = 0;  // pairs of leaves among them
};

// When a query may stop.
struct CollisionRequest {
  // Stop after this many pairs (1 finds whether there is a collision and one witness).
  std::size_t max_pairs = std::numeric_limits<std::size_t>::max();
  // Give up after this many node tests or this time (looked up once in some hundred node tests),
  // with the verdict kUnknown unless a pair was found.
  std::uint64_t max_node_tests = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds max_time = std::chrono::nanoseconds::max();
};

// Indices of two overlapping spheres, into SphereTree::spheres() of a and of b.
struct SpherePair {
  std::int32_t a = -1;
  std::int32_t b = -1;
  // By the index in a, then by that in b.
  friend auto operator<=>(const SpherePair&, const SpherePair&) = default;
};

// What collide() found.
struct CollisionResult {
  Verdict verdict = Verdict::kUnknown;
  // Sorted; all overlapping pairs unless a limit was reached.
  std::vector<SpherePair> pairs;
  bool complete = false;  // no limit cut the search short
  // No two spheres come closer than this (0 if a pair was found or the search was cut short).
  double distance_lower_bound = 0.0;
  QueryCost cost;
};

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

}  // namespace spherule

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

namespace spherule {

// How closely a distance is to be known.
struct DistanceRequest {
  // Stop when upper - lower is at most this, or when lower exceeds `enough`.
  double tolerance = 0.0;
  double enough = std::numeric_limits<double>::infinity();
  // Stop after this many node tests or this time (looked up once in some hundred node tests).
  std::uint64_t max_node_tests = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds max_time = std::chrono::nanoseconds::max();
};

// What distance() found.
struct DistanceResult {
  // Bounds of the separation distance of the two sets in exact arithmetic, whatever ended the
  // search. Of sets that overlap or touch `lower` is 0, and `upper` is 0 once a pair is found that
  // overlaps by more than rounding. 0 and infinity, and no pair, if a limit forbids every test.
  double lower = 0.0;
  double upper = std::numeric_limits<double>::infinity();
  SpherePair nearest;  // the pair that gives `upper`
  QueryCost cost;
};

// Separation distance of two sets of spheres, rigidly placed, between certified bounds.
DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const DistanceRequest& request = {});

}  // namespace spherule

// Do two sets of spheres come within a clearance of each other?
//
// @code{.cpp}
//
// const auto tree = spherule::build_tree(std::vector<spherule::Sphere>{{{0, 0, 0}, 1}});
// const auto apart = spherule::Pose::from_translation({3, 0, 0});
// assert(within(tree, {}, tree, apart, 1.0));
// assert(!within(tree, {}, tree, apart, 0.999));
// @endcode

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
