// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace spherule {

// What is wrong with a command line, in one line: what is not known comes first, with the name that
// may have been meant, then what is missing; and where the help is.
std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error);

// The command that the command line has got to, the application itself at first.
const CLI::App& command_reached(const CLI::App& app);

}  // namespace spherule
