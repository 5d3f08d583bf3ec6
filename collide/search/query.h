// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What queries of two bodies are given and return (collide/collide.h).
//
// @code{.cpp}
// #include <spherule/collide/search/query.h>
// #include <cassert>
//
// const spherule::CollisionResult result;
// assert(result.verdict == spherule::Verdict::kUnknown && !result.complete);
// @endcode

#include <Eigen/Core>

#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
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
  bool complete = true;  // no limit of tests or time cut the search short
};

// What shows that two bodies touch.
enum class ContactKind {
  kLeaves,     // two leaves: spheres of trees, triangles of meshes, solids
  kTriangles,  // of two covered meshes: triangles under two spheres
  kInside,     // no leaves touch, but one body, or a component of it, lies inside the other
};

// A triangle of each of two meshes.
struct TrianglePair {
  std::int32_t a = 0;
  std::int32_t b = 0;
};

// One contact of two bodies, in the world.
struct Contact {
  ContactKind kind = ContactKind::kLeaves;
  // Which leaves: indices of spheres, for two covered meshes of their covers; of triangles; 0 for a
  // solid. Where a sphere touches a SolidMesh, -1 stands for the inside. For kInside the two
  // nearest leaves; of two covered meshes the two spheres that overlap deepest.
  SpherePair leaves;
  // Lower bound of the penetration depth of these two leaves, in exact arithmetic under exactly the
  // given poses: so far, at least, one of them has to be moved for the two to part; for kInside one
  // body, but of two covered meshes the two spheres of their covers. In the unit of the bodies,
  // rounded downward; below zero where rounding alone may have made them touch. Nothing is said of
  // how far the bodies have to be moved to part.
  double penetration_depth = 0.0;
  // Of length 1, from a to b: the direction in which b leaves a soonest, up to rounding.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  // Up to rounding: a point of each leaf on its boundary, the one of a the deepest in b, and that
  // of b in a; and a point of both, for spheres in the middle.
  std::array<Eigen::Vector3d, 2> nearest_points{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  // For kTriangles, as touching_triangles() says.
  std::optional<TrianglePair> triangles;
};

// Throws Error for a number that is no clearance: negative, not a number, or beyond 1e15.
void require_clearance(double clearance);

}  // namespace spherule
