// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/cad/cad_file.h"

#include <filesystem>
#include <vector>

namespace spherule {

// read_cad() and read_cad_bodies() in a process of their own, the program `spherule_cad` beside the
// command's modules: OpenCASCADE's readers are not written for hostile files, which may make them
// crash or go on without end. The process may take 30 s of processor time, and 60 s more for each
// million bytes of the file; ten times that where a chord error is requested. It ends with this
// process, or soon after.
//
// Throws Error as these functions do, and, naming the file, where the process crashes, takes
// longer, or runs out of memory.
CadPart read_cad_apart(const std::filesystem::path& path, const CadReadOptions& options);
std::vector<CadBody> read_cad_bodies_apart(const std::filesystem::path& path,
                                           const CadReadOptions& options);

}  // namespace spherule
