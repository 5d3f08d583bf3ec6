// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace spherule {

// Endings of file names, in small letters, without the dot.
using FileEndings = std::vector<std::string>;

// Those of the mesh formats that are read.
const FileEndings& mesh_endings();

// Those that completion offers for an argument, by the name that it has in every command: "urdf",
// "mesh". Empty: files of all kinds.
FileEndings endings_for(const std::string& argument);

}  // namespace spherule
