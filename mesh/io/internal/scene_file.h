// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

// The formats that are scene graphs (COLLADA, glTF) are read by assimp.

namespace spherule::internal {

// Reads the scene of the file, whose content is `bytes` and whose lower-case extension is
// `extension` ("dae", "gltf" or "glb"): every mesh under the transforms of each node that
// shows it. COLLADA files come out in metres (their own <unit> applied) with the axes as they stand
// in the file (<up_axis> is ignored, as the tools of ROS do); the others come out in their own
// numbers. Bones and morphs stay at rest.
//
// The reader works in 32-bit floats; `vertex_error` charges
//  - for text, kDecimalError of the largest coordinate: assimp rounds the whole part, the fraction,
//    their sum and the power of ten each to a float;
//  - for every node transform that is not the identity, kTransformError of the sizes it handles;
//  - the rounding of the product in double.
TriangleMesh read_scene(const std::filesystem::path& path, std::string_view bytes,
                        const std::string& extension);

// Relative error of a decimal number as read by assimp: up to three roundings of a float and a
// power of ten of two more.
inline constexpr double kDecimalError = 8.0 * 0x1p-24;

// Throws Error if assimp would misread the COLLADA text without a word, or never come back: a
// number that it does not read to within kDecimalError (it drops digits beyond the 15th decimal,
// and whole parts of 20 digits wrap around or become zero), or an index that is not a whole number.
void check_collada(std::string_view text, const std::string& subject);

// The size in metres that a COLLADA text states of its unit; 1 where it states none.
double collada_unit(std::string_view text, const std::string& subject);

// Throws Error if the glTF or GLB file holds something that assimp reads wrongly without a word or
// falls over: positions that are not 32-bit floats (it copies their bytes), compressed meshes,
// sparse accessors, nodes in a loop. Returns the number of triangles of the meshes shown, each
// counted once: assimp drops those whose corners are out of range, so it must find as many.
std::size_t check_gltf(std::string_view bytes, const std::string& subject);

}  // namespace spherule::internal
