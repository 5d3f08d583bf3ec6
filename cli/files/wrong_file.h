// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace spherule {

// Of a command that failed with `message`: what the first file is that the message names and that
// is of a kind which the command does not take in its place, and which command takes it, as the end
// of the message; or nothing. Does not throw for files that cannot be read.
std::string wrong_file_hint(const CLI::App& app, const std::string& message);

}  // namespace spherule
