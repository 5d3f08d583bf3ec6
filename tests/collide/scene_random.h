// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"

#include <cmath>
#include <cstdint>
#include <random>

namespace spherule::test {

// Numbers from a seeded engine, the same with every standard library.
class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  Eigen::Vector3d point(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  // Not normalised; its length varies over many orders of magnitude.
  Eigen::Quaterniond quaternion() {
    const double length = std::ldexp(1.0, whole(-60, 60));
    return {uniform(-1.0, 1.0) * length, uniform(-1.0, 1.0) * length, uniform(-1.0, 1.0) * length,
            uniform(0.1, 1.0) * length};
  }
  // Drawn one after the other: compilers evaluate arguments in orders of their own.
  Pose pose(double size) {
    const Eigen::Vector3d place = point(size);
    return Pose(quaternion(), place);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace spherule::test
