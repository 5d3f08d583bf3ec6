// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Seeded families of spheres, usual and degenerate, for the tests in this folder. The numbers come
// from the generator's output directly, so they are the same with every standard library.

#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace spherule::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  std::uint64_t bits() { return generator_(); }
  // Uniform in [0, 1), [low, high) and {0, ..., count - 1}.
  double unit() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }

  Eigen::Vector3d in_cube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    return {x, y, between(-half, half)};
  }
  Eigen::Vector3d direction();

 private:
  std::mt19937_64 generator_;
};

struct Family {
  std::string name;
  std::vector<Sphere> spheres;
};

// Every family with `count` spheres. Deterministic in `seed`.
std::vector<Family> sphere_families(std::size_t count, std::uint64_t seed);

}  // namespace spherule::test
