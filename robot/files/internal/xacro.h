// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace spherule::internal {

// Why a file of another name is refused that holds what only that program understands.
inline constexpr const char* kIsForXacro =
    "this is for xacro, which makes a URDF of it: rename the file, so that it ends in .xacro";

// Whether the name of the file says that it is one for the program `xacro`: it ends in .xacro.
bool is_xacro(const std::filesystem::path& path);

// The text of a URDF file; of one for xacro, what `xacro`, as the PATH has it, makes of it without
// arguments. What xacro has to say goes to standard error. Throws Error, naming the file, where it
// cannot be read, or there is no such program or it fails.
std::string urdf_text(const std::filesystem::path& path);

}  // namespace spherule::internal
