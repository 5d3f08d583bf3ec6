// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace spherule {

struct PlanningArguments {
  std::filesystem::path out = "bench/out";
  int effort = 3;  // of the fits
  std::size_t problems = 200;
};

// What main() of a program of that name does and returns: reads --out DIR --effort N, and
// --problems N for who studies `many`, makes that folder, keeps OMPL quiet but for errors, and
// runs. Says on standard error what went wrong, arguments that are not known and numbers below 1
// included; the exit code is 1 then, otherwise 0.
int run_planning_program(const std::string& name, int count, char** values, bool many,
                         const std::function<void(const PlanningArguments&)>& run);

}  // namespace spherule
