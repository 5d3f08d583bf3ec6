// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The separation distance of two sets of spheres, between proved bounds.
//
// @code{.cpp}
// #include <spherule/collide/distance.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const auto apart = spherule::Pose::from_translation({7, 0, 0});
// const spherule::DistanceResult found = distance(tree, {}, tree, apart);
// assert(found.lower <= 3.0 && 3.0 <= found.upper && found.upper < 3.001);
// @endcode

#include "collide/collide.h"

#include <chrono>

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
