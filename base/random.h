// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <random>

namespace spherule::internal {

// A seed for each of several things made at once, whatever the threads.
constexpr std::uint64_t seed_of(std::uint64_t seed, std::size_t number) {
  return seed + 0x9e3779b97f4a7c15U * (number + 1);
}

// Random numbers that are equal on every platform: the standard fixes the engine's output but not
// that of its distributions, so the numbers are made from the output directly.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // Uniform in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  // Uniform up to a bias below size / 2^64.
  std::size_t index(std::size_t size) { return static_cast<std::size_t>(engine_() % size); }
  Eigen::Vector3d in(const Eigen::AlignedBox3d& box) {
    const double x = between(box.min().x(), box.max().x());
    const double y = between(box.min().y(), box.max().y());
    const double z = between(box.min().z(), box.max().z());
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace spherule::internal
