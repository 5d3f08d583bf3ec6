// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/pairs/internal/pair_space.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace spherule::internal {

// Where two links come nearest, as far as a search finds it.
struct PairWitness {
  double gap = std::numeric_limits<double>::infinity();  // not below the exact one but by rounding
  std::vector<double> configuration{};                   // of the whole robot
  bool touches() const { return gap == 0.0; }
};

// Searches for a configuration in which two links touch: samples of the ranges, every fourth with
// variables at their limits, then descents from those with the least gap by random steps that are
// cut off at the limits. Gaps are those of exact tests within clearances, inside counted. The same
// for the same seed.
PairWitness find_witness(const PairSpace& space, std::size_t samples, std::uint64_t seed);

}  // namespace spherule::internal
