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

#include "spheretree/pose.h"
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
