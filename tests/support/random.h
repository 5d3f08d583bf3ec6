// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace spherule::test {

// Seeded random numbers that are the same on every library: taken from the bits of the generator,
// not from std::uniform_*_distribution.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t bits() { return bits_(); }
  // In [0, 1).
  double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  // In [0, count).
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }

  Eigen::Vector3d in_box(const Eigen::AlignedBox3d& box) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = between(box.min()[k], box.max()[k]);
    return p;
  }

  // Uniform on the unit sphere, by rejection from the cube.
  Eigen::Vector3d direction() {
    const Eigen::AlignedBox3d cube(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
    for (;;) {
      const Eigen::Vector3d p = in_box(cube);
      const double n = p.norm();
      if (n <= 1.0 && n > 0.01) return p / n;
    }
  }

  // Uniform over all rotations (a random direction in four dimensions).
  Eigen::Quaterniond rotation() {
    for (;;) {
      Eigen::Vector4d q;
      for (int k = 0; k < 4; ++k) q[k] = between(-1, 1);
      const double n = q.norm();
      if (n <= 1.0 && n > 0.01) return Eigen::Quaterniond(q / n);
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace spherule::test
