// SPDX-License-Identifier: BSD-3-Clause
// The twin in C++ of bench/python/call_costs, which writes the scene and runs both. Prints
// processor nanoseconds a configuration: of check_configs() and check_edges() of all, and of
// check_config() of one at a time. Usage: python_twin FOLDER

#include "tests/python/cell_files.h"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <span>
#include <vector>

namespace spherule {
namespace {

double processor_seconds() {
  timespec now = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The least of five, in nanoseconds for each of `count`.
template <class Work>
double measure(std::size_t count, const Work& work) {
  double least = 1e300;
  for (int round = 0; round < 5; ++round) {
    const double start = processor_seconds();
    work();
    least = std::min(least, processor_seconds() - start);
  }
  return 1e9 * least / static_cast<double>(count);
}

void run(const std::filesystem::path& folder) {
  const RobotChecker checker = checker_in(folder);
  const std::vector<double> configurations = read_doubles(folder / "configurations");
  const std::span<const double> all(configurations);
  const auto dof = static_cast<std::size_t>(checker.robot().variable_count());
  const std::size_t count = all.size() / dof;

  std::vector<RobotChecker::Scratch> scratches;
  scratches.emplace_back(checker);
  std::vector<std::uint8_t> free(count);
  std::cout << measure(count, [&] { checker.check_configs(all, scratches.front(), free); }) << '\n';
  const std::size_t edges = count / 20;
  std::cout << measure(edges, [&] {
    checker.check_edges(all.first(edges * dof), all.subspan(dof, edges * dof), scratches);
  }) << '\n';
  std::cout << measure(count, [&] {
    for (std::size_t i = 0; i < count; ++i) {
      free[i] = checker.check_config(all.subspan(i * dof, dof), scratches.front());
    }
  }) << '\n';
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  try {
    if (argc != 2) return 2;
    spherule::run(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
