// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Whether two sets of spheres overlap, queried again and again under poses that change little.
//
// @code{.cpp}
// #include <spherule/collide/pair_cache.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// spherule::PairCache cache(tree, tree);
// for (const double x : {6.0, 5.999, 5.998, 5.997}) {
//   assert(!cache.collides({}, spherule::Pose::from_translation({x, 0, 0})));
// }
// assert(cache.counts().queries == 4 && cache.counts().free_from_memory > 0);
// @endcode

#include "collide/collide.h"

#include <array>
#include <optional>

namespace spherule {

// collides() for two sets that are queried again and again under poses that change little. It
// answers exactly as collides() does, always; the memory only saves work:
//   - after a free answer it knows a clearance, proved where the bodies stood then. As long as they
//     have moved against each other by less, no tree is examined;
//   - after a collision, the two spheres that touched are tried first.
// Not thread-safe: each thread needs one of its own.
class PairCache {
 public:
  // Both trees must outlive it and not be moved. Throws Error unless this thread rounds to nearest.
  PairCache(const SphereTree& a, const SphereTree& b);

  // Exactly what collides() answers for the two trees.
  bool collides(const Pose& world_from_a, const Pose& world_from_b);

  // What has been queried, and how many of the answers came from memory.
  struct Counts {
    std::uint64_t queries = 0;
    std::uint64_t free_from_memory = 0;
    std::uint64_t collisions_from_memory = 0;
  };
  // Since the cache was made.
  const Counts& counts() const { return counts_; }

 private:
  // One set seen from the other, where the trees were last searched.
  struct Seen {
    std::array<double, 12> other_from_mover;  // rotation in row order, then the translation
    double scene_size;
    double clearance;  // no two spheres came closer than this; 0 if nothing is known
  };

  double way_between(const Seen& before, const Seen& now) const;

  const SphereTree& a_;
  const SphereTree& b_;
  const bool a_moves_;  // the set of smaller reach is the one seen from the other
  const double reach_;  // its reach
  std::optional<Seen> before_;
  std::uint64_t queries_since_ = 0;  // since `before_`
  std::optional<SpherePair> witness_;
  Counts counts_;
};

}  // namespace spherule
