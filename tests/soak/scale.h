// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/support/effort.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace spherule::test {

// The environment variable SPHERULE_SCALE multiplies the number of random cases of a property
// test, and SPHERULE_SEED gives other ones (tests/run --scale N --seed S).
inline int scale() {
  const char* const text = std::getenv("SPHERULE_SCALE");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

inline int scaled(int cases) {
  return scale() * cases;
}
inline int scaled(int cases, int under_sanitizers) {
  return scale() * effort(cases, under_sanitizers);
}

inline std::uint64_t seeded(std::uint64_t seed) {
  const char* const text = std::getenv("SPHERULE_SEED");
  return seed + (text == nullptr ? 0 : 1'000'003 * std::strtoull(text, nullptr, 10));
}

}  // namespace spherule::test
