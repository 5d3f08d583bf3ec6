// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <random>

namespace spherule {

// Seeded; the same on every library, since they are made of the generator's bits.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : bits_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }

  // Uniform in directions and rotations, by rejection from the cube.
  Eigen::Vector3d direction() { return in_sphere<Eigen::Vector3d>().normalized(); }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond(in_sphere<Eigen::Vector4d>().normalized().eval());
  }

 private:
  template <class Vector>
  Vector in_sphere() {
    for (;;) {
      Vector v;
      for (double& x : v) x = between(-1.0, 1.0);
      const double norm = v.norm();
      if (norm <= 1.0 && norm > 0.01) return v;
    }
  }

  std::mt19937_64 bits_;
};

}  // namespace spherule
