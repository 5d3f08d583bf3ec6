// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

// The readers of the single formats. Each turns the bytes of a file into a mesh, vertices as they
// stand in it and not welded, with `vertex_error` set; numbers need not be in range yet. `subject`
// names the file in an Error.

namespace spherule::internal {

// Meshes in the unit of the file.
TriangleMesh read_stl(std::string_view bytes, const std::string& subject);
TriangleMesh read_obj(std::string_view bytes, const std::string& subject);
TriangleMesh read_off(std::string_view bytes, const std::string& subject);
TriangleMesh read_ply(std::string_view bytes, const std::string& subject);

// Scenes: every mesh under the transforms of each node that shows it. What would be shown in
// another way than the format specifies is refused. Numbers are read as doubles; `vertex_error`
// charges their rounding and that of the transforms, some 2^-45 of the coordinates. Throw Error.
//
// COLLADA files come out in metres (their own <unit> applied) with the axes as they stand in the
// file (<up_axis> is ignored, as the tools of ROS do); glTF and 3MF files in their own numbers.
TriangleMesh read_3mf(std::string_view bytes, const std::string& subject);
TriangleMesh read_collada(std::string_view bytes, const std::string& subject);
TriangleMesh read_gltf(std::string_view bytes, const std::filesystem::path& path);

// The size in micrometres of the unit that a 3MF file states. Throws Error.
double unit_of_3mf(std::string_view bytes, const std::string& subject);
// The size in metres that a COLLADA text states of its unit; 1 where it states none.
double collada_unit(std::string_view text, const std::string& subject);

}  // namespace spherule::internal
