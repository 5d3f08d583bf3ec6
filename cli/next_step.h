// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace spherule {

// A command that a user is likely to want next, and what for.
struct NextStep {
  std::vector<std::string> words;
  std::string purpose;
};

// A line for each, to be copied into a shell: names of files are quoted where they need it.
std::string describe(const std::vector<NextStep>& steps);

// The name of a file beside `path`: with another ending, ".html" say, in the place of its own.
std::string beside(const std::string& path, const std::string& ending);

}  // namespace spherule
