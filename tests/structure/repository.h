// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace spherule {

// The folder of the repository that is examined.
inline const std::filesystem::path kRoot = SPHERULE_SOURCE_DIR;

// Empty if the file cannot be read.
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace spherule
