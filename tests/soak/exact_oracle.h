// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "geometry/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::test {

// Spheres under exactly the motion p -> R(q / |q|) p + t of a pose.
struct PlacedSet {
  std::span<const Sphere> spheres;
  Pose world_from_set;
};

// Bounds of a gap; negative where spheres overlap.
struct GapBounds {
  long double lower;
  long double upper;
};

// What is true of two placed sets of spheres, found from all pairs. Shares no code with collide/:
// double with a bound of its error decides most pairs, long double most of the others, and rational
// numbers, in which the rotation of q / |q| is exact, the rest.
class ExactOracle {
 public:
  // Whether two spheres, one of each set, are at most `clearance` apart, in exact arithmetic.
  bool within(const PlacedSet& a, const PlacedSet& b, double clearance);

  // The least gap of two spheres, one of each set.
  GapBounds gap(const PlacedSet& a, const PlacedSet& b);

  // Pairs of spheres that had to be decided in rational numbers.
  std::uint64_t rational_pairs() const { return rational_pairs_; }

 private:
  struct Spheres {
    void place(const PlacedSet& set);

    std::vector<double> x, y, z;
    std::vector<double> radius;
    std::vector<double> error;  // of the place, and of what is computed with it
  };

  Spheres a_, b_;
  std::uint64_t rational_pairs_ = 0;
};

}  // namespace spherule::test
