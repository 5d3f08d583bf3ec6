// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// The folder of the repository that is examined.
inline const std::filesystem::path kRoot = SPHERULE_SOURCE_DIR;

// Empty if the file cannot be read.
std::string text_of(const std::filesystem::path& file);

// All files in the folders of sources below `root`, relative to it and sorted, but for what
// bench/run writes.
std::vector<std::string> files_of_sources(const std::filesystem::path& root);

bool is_cpp(std::string_view path);

struct Include {
  std::string target;  // relative to the root, if it is ours
  bool is_ours;        // "..." or, as users of the installed package write, <spherule/...>
};
std::vector<Include> includes_of(const std::string& text);

}  // namespace spherule
