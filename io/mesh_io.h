// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Meshes from files, and STL files from meshes.
//
// @code{.cpp}
// #include <spherule/io/mesh_io.h>
// #include <cassert>
// #include <filesystem>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.stl";
// spherule::write_stl(tetrahedron, path);
// const spherule::TriangleMesh read = spherule::read_mesh(path, {.scale = 1000});  // metres to mm
// assert(read.triangles.size() == 4 && read.vertices.size() == 4);
// @endcode

#include "geometry/triangle_mesh.h"

#include <filesystem>

namespace spherule {

// How a file is read.
struct MeshReadOptions {
  // Factor from the unit of the file to the unit of the model (1000 turns metres into millimetres).
  double scale = 1.0;
  // Vertices that are no further apart than this, in units of the model, become one: it shuts the
  // cracks that are left where a file stores a vertex twice with other roundings, which make a mesh
  // open. `vertex_error` grows by it. 0: only equal vertices are joined.
  double weld = 0.0;
};

// Reads STL (text and binary), OBJ, PLY, OFF, DAE, 3MF, glTF and GLB, told apart by the extension.
// All meshes of the file are joined, each under its node transforms, with its triangles turned over
// where these mirror. Polygons are divided into triangles, planar ones without adding to them (but
// 1e-9 of their area) or leaving any of them out (one that crosses itself becomes a fan about its
// first corner); vertices that are equal bit for bit are joined. Degenerate, duplicated, open, non-
// manifold, inverted and self-intersecting triangles are kept (mesh_report() tells of them); points
// and lines are left out. A DAE file comes out in metres, times `scale` (its own <unit> is
// applied), with the axes as they stand in it (<up_axis> is ignored, as the tools of ROS do); one
// in which the <asset> of a part states another unit or <up_axis> than that of the document is
// refused. The other formats come out in their own numbers times `scale` (a 3MF file in its own
// unit, of which the default is the millimetre). Skins and morph targets are refused, as is what
// would be shown in another way than the format specifies, and a file that shows more than 2^25
// vertices and triangles, or refers to its parts too often (docs/security.md). What a 3MF file
// shows must be meshes: extensions of the format that it requires, or that add other shapes, are
// refused.
//
// `vertex_error` bounds what reading cost: nothing for binary STL and PLY and for glTF without node
// transforms; 2^-53 of the largest coordinate for numbers in text, which are read as doubles, and
// some 2^-45 of it where 3MF, DAE and glTF transform them; and the rounding of the scale (per
// coordinate; the bound itself is of the distance); and `weld`.
//
// Throws Error, naming file and reason: no such file, not a mesh, cut short, no triangles, a
// coordinate that is not finite or beyond kMaxCoordinate after scaling, an index out of range, a
// bad option.
TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

// Whether the name ends as those of STEP and IGES files do (step, stp, iges, igs). read_mesh()
// refuses these; read_cad() of the component `cad` reads them.
bool is_cad_file(const std::filesystem::path& path);

// Writes binary STL; the coordinates are rounded to 32-bit floats. The file appears whole or not at
// all. Throws Error, naming the file, for a mesh that validate() refuses and if it cannot be
// written.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace spherule
