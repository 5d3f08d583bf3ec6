// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace spherule {

enum class FileKind { kMesh, kSpheres, kTree };

// What a file is, by its content: a sphere tree by its magic number, a set of spheres by its format
// name, anything else is left to the mesh reader to accept or refuse. Throws Error if the file
// cannot be read.
FileKind recognize(const std::filesystem::path& path);

}  // namespace spherule
