// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spherule {

// A command that a user is likely to want next, and what for. What is not known of it, another
// part's tree say, stands there as a placeholder in capitals, or as its form ("x y z qx qy qz qw").
struct NextStep {
  std::vector<std::string> words;
  std::string purpose;
};

// A line for each, to be copied into a shell: names of files are quoted where they need it.
std::string describe(const std::vector<NextStep>& steps);

// The name of a file beside `path`: with another ending, ".html" say, in the place of its own.
std::string beside(const std::string& path, const std::string& ending);
// The same name in the current folder, where what is made of others' files goes.
std::string here(const std::string& path, const std::string& ending);

// Adds an option to the words of a command, as it was given to this one, and nothing where it was
// not (an empty text). Numbers are written so that they are read back without loss.
void repeat(const std::string& option, const std::string& value, std::vector<std::string>& words);
void repeat(const std::string& option, std::optional<double> value,
            std::vector<std::string>& words);

}  // namespace spherule
