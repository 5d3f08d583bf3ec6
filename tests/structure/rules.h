// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// Checks the sources of the project against its rules: who may include whom, which third party is
// seen by which file (the table stands in rooms.cpp), SPDX line first, at most kMaxLines lines,
// `#pragma once` in headers, no JSON values that are null at first.
inline constexpr std::size_t kMaxLines = 400;

// What is wrong with one file, given its path relative to the root of the project. Each problem
// names file and line.
std::vector<std::string> check_file(const std::string& path, std::string_view text);

// A source that has a header of its name includes it before all others, so that the compiler shows
// what the header lacks where sources are not joined. Empty if this one does.
std::vector<std::string> check_first_include(const std::string& path, std::string_view text);

// A header of a library is public exactly if its CMakeLists.txt lists it under HEADERS; private
// ones live in internal/. What is wrong with the `headers` of the library in `folder`, whose paths
// are relative to it, given the text of its CMakeLists.txt.
std::vector<std::string> check_public_headers(const std::string& folder, std::string_view cmake,
                                              const std::vector<std::string>& headers);

// All of these for all sources below `root`; `files` counts them.
std::vector<std::string> check_sources(const std::filesystem::path& root, std::size_t& files);

}  // namespace spherule
