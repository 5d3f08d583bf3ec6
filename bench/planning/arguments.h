// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

namespace spherule {

struct PlanningArguments {
  std::filesystem::path out = "bench/out";
  int effort = 3;  // of the fits
  std::size_t problems = 200;
};

// --out DIR --effort N, and --problems N for who studies `many`. Throws Error for anything else and
// for numbers below 1.
PlanningArguments parse_planning_arguments(int count, char** values, bool many);

}  // namespace spherule
