// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace spherule {

// How long is searched for fewer spheres, where a command keeps it.
struct SearchOptions {
  std::uint64_t& seed;
  int& effort;
  double& seconds;
  int& threads;
};

// Adds --seed, --effort, --seconds and --threads to a command, with what the second and the third
// mean there. The options have to outlive the command.
void add_search_options(CLI::App& command, const SearchOptions& options,
                        const std::string& effort_means, const std::string& seconds_mean);

}  // namespace spherule
