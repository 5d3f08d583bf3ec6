// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/cli/command_test_support.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

using RunCommand = std::function<Outcome(const std::vector<std::string>&)>;

std::vector<std::string> lines_of(const std::string& text);

// The first words of the lines below the heading, up to an empty line.
std::vector<std::string> names_below(const std::string& help, const std::string& heading);

// The command lines under "Examples:".
std::vector<std::string> examples_in(const std::string& help);

// The help of every command by its names, "baseline hull" say, in the order of the help that lists
// them; that list itself comes last.
std::vector<std::pair<std::string, std::string>> help_pages(const RunCommand& run);

}  // namespace spherule
