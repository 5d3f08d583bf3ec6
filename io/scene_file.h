// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

// The formats that are scene graphs: COLLADA and glTF.

namespace spherule::internal {

// Read the scene of the file, whose content is `bytes`: every mesh under the transforms of each
// node that shows it, skins and morph weights as the file states them. What would be shown in
// another way than the format specifies is refused. Numbers are read as doubles; `vertex_error`
// charges their rounding and that of the transforms, some 2^-45 of the coordinates. Throw Error.
//
// COLLADA files come out in metres (their own <unit> applied) with the axes as they stand in the
// file (<up_axis> is ignored, as the tools of ROS do); glTF files in their own numbers.
TriangleMesh read_collada(std::string_view bytes, const std::string& subject);
TriangleMesh read_gltf(std::string_view bytes, const std::filesystem::path& path);

// The size in metres that a COLLADA text states of its unit; 1 where it states none.
double collada_unit(std::string_view text, const std::string& subject);

}  // namespace spherule::internal
