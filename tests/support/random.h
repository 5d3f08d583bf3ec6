// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

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
  // In [0, count), and from `low` to `high`, both of which occur.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
  int whole(int low, int high) {
    return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return whole(0, 1) == 1; }
  double sign() { return coin() ? -1.0 : 1.0; }
  bool chance(double share) { return unit() < share; }
  // As many of each order of magnitude.
  double magnitude(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  // 0, +-1e-12, +-1e-9, +-1e-6, +-1e-4, anything up to 2e-3, or of any order of magnitude.
  double small_gap() {
    constexpr double kGaps[] = {0.0, 1e-12, 1e-9, 1e-6, 1e-4};
    const int kind = whole(0, 6);
    const double gap = kind < 5 ? kGaps[kind] : kind == 5 ? 2e-3 * unit() : magnitude(1e-17, 1e-3);
    return sign() * gap;
  }

  Eigen::Vector3d in_box(const Eigen::AlignedBox3d& box) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = between(box.min()[k], box.max()[k]);
    return p;
  }
  // In the cube about the origin with edges of twice this size.
  Eigen::Vector3d point(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  // Uniform on the unit sphere, by rejection from the cube.
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d p = point(1.0);
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
  // Not normalised; its length varies over many orders of magnitude.
  Eigen::Quaterniond quaternion() {
    const double length = std::ldexp(1.0, whole(-60, 60));
    return {between(-1.0, 1.0) * length, between(-1.0, 1.0) * length, between(-1.0, 1.0) * length,
            between(0.1, 1.0) * length};
  }
  // Drawn one after the other: compilers evaluate arguments in orders of their own.
  Pose pose(double size) {
    const Eigen::Vector3d place = point(size);
    return Pose(quaternion(), place);
  }

 private:
  std::mt19937_64 bits_;
};

// The bytes with one to four changes: overwritten, flipped, inserted, removed or copied ones, or a
// cut. New ones are from the alphabet, or any if it is empty.
inline std::string mutated(std::string bytes, Random& random, std::string_view alphabet = {}) {
  const auto any_byte = [&] {
    return alphabet.empty() ? static_cast<char>(random.index(256))
                            : alphabet[random.index(alphabet.size())];
  };
  const std::size_t changes = 1 + random.index(4);
  for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t at = random.index(bytes.size());
    const std::size_t length = 1 + random.index(16);
    switch (random.index(6)) {
      case 0:
        bytes[at] = any_byte();
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.index(8)));
        break;
      case 2:
        bytes.insert(at, 1 + random.index(8), any_byte());
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(random.index(bytes.size()), bytes.substr(at, length));
        break;
      default:
        bytes.resize(at);
        break;
    }
  }
  return bytes;
}

}  // namespace spherule::test
