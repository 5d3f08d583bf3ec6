// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/crc64.h"
#include "geometry/sphere.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>

namespace spherule::test {

// Of the bits of all numbers, the lowest byte first.
inline std::uint64_t hash_of(std::span<const Sphere> spheres) {
  std::string bytes;
  for (const Sphere& s : spheres) {
    for (const double x : {s.center.x(), s.center.y(), s.center.z(), s.radius}) {
      const auto bits = std::bit_cast<std::uint64_t>(x);
      for (int shift = 0; shift < 64; shift += 8) {
        bytes.push_back(static_cast<char>(static_cast<unsigned char>(bits >> shift)));
      }
    }
  }
  return crc64(bytes);
}

}  // namespace spherule::test
