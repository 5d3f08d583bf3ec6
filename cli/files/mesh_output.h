// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <filesystem>
#include <span>
#include <string>

namespace spherule {

// Throws Error unless the name ends in .stl, .obj or .ply (in any case), or is a folder that is
// there, for which the name of a part decides.
void check_mesh_output(const std::filesystem::path& path);

// Whether what is written there is rounded, so that what was proved of the mesh need not hold of
// it.
bool rounds_coordinates(const std::filesystem::path& path);

// Writes the meshes into one file, a component (in OBJ an object) each, in the format that its name
// requires; or, if `path` is a folder, each as an OBJ file of its own, part-0001.obj and on. OBJ
// and PLY hold the coordinates bit for bit, STL rounds them to 32-bit floats. Each file appears
// whole or not at all. Throws Error.
void write_meshes(std::span<const TriangleMesh> meshes, const std::filesystem::path& path);

}  // namespace spherule
