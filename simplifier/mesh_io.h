// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/triangle_mesh.h"

#include <filesystem>

namespace spherule {

struct MeshReadOptions {
  // Factor from the unit of the file to the unit of the model (1000 turns metres into millimetres).
  double scale = 1.0;
};

// Reads STL (text and binary), OBJ, PLY, OFF, DAE, 3MF, glTF and GLB. All meshes of the file are
// joined, each under its node transforms, with polygons as triangle fans. Degenerate, duplicated,
// open, non-manifold, inverted and self-intersecting triangles are kept (mesh_report() tells of
// them). `vertex_error` bounds what reading cost: half a unit in the last place of a 32-bit float
// where the file stores more than that, and the rounding of transforms and scale. Throws Error,
// naming file and reason: no such file, not a mesh, no triangles, a coordinate that is not finite
// or beyond kMaxCoordinate after scaling, an index out of range, a bad option.
TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

// Writes binary STL; the coordinates are rounded to 32-bit floats. The file appears whole or not at
// all. Throws Error.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace spherule
