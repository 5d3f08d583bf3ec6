// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace spherule::internal {

// What stands behind the last dot of the name, in lower case.
std::string lower_extension(const std::filesystem::path& path);

// The bytes of the file. Throws Error, naming it, if it is not a file or is empty.
std::string read_regular_file(const std::filesystem::path& path);

}  // namespace spherule::internal
