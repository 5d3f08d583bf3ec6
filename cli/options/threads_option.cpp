// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/threads_option.h"

#include "cli/options/check_number.h"

#include <CLI/CLI.hpp>

namespace spherule {

void add_threads_option(CLI::App& command, int& threads, const std::string& result) {
  command.add_option("--threads", threads, "Threads, 0: all; " + result)->check(check_not_negative);
}

}  // namespace spherule
