// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace spherule {

// Adds --threads to a command, with what is said of its result.
void add_threads_option(CLI::App& command, int& threads,
                        const std::string& result = "the result is the same");

}  // namespace spherule
