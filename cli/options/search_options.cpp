// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/search_options.h"

#include "cli/options/check_number.h"
#include "cli/options/threads_option.h"

#include <CLI/CLI.hpp>

#include <limits>

namespace spherule {

void add_search_options(CLI::App& command, const SearchOptions& options,
                        const std::string& effort_means, const std::string& seconds_mean) {
  // Without the check CLI11 takes -1 for the largest number; files store 63 bits.
  command.add_option("--seed", options.seed, "Seed of everything random")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  auto* effort = command.add_option("--effort", options.effort, effort_means);
  effort->check(check_not_negative);
  command
      .add_option_function<double>(
          "--seconds",
          [options](double seconds) {
            options.seconds = seconds;
            options.effort = std::numeric_limits<int>::max();
          },
          seconds_mean)
      ->check(check_positive)
      ->excludes(effort);
  add_threads_option(command, options.threads);
}

}  // namespace spherule
