// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Meshes from files, STL files from meshes, and units of length.
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
#include <optional>
#include <span>
#include <string>
#include <string_view>

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

// Units of length, in texts and in files.
//
// @code{.cpp}
// #include <cmath>
//
// const auto length = spherule::parse_length("0.5 in");
// const spherule::LengthUnit* const millimetre = spherule::unit_named("mm");
// assert(std::abs(spherule::in_units_of(millimetre->micrometres, *length) - 12.7) < 1e-12);
// assert(!spherule::stated_unit("part.stl"));  // the format has none
// @endcode

// A unit of length. Sizes are in micrometres, so that those of the table are whole numbers and the
// quotient of two of them is rounded once.
struct LengthUnit {
  const char* symbol;  // "mm"
  const char* name;    // "millimetre"
  const char* plural;
  double micrometres;
};

// All units that lengths may be written in: micrometre, millimetre, centimetre, metre, inch, foot.
std::span<const LengthUnit> length_units();

// The unit of this symbol or name, also as other programs spell it (in, micron, MILLIMETER), or
// null.
const LengthUnit* unit_named(std::string_view text);

// The unit of this size, up to rounding, or null.
const LengthUnit* unit_of_size(double micrometres);

// "millimetre", or "0.3 metres" for a size that is no unit's.
std::string name_of_size(double micrometres);

// A length as it is written: "0.5", "1mm", "0.5 in".
struct Length {
  double value = 0.0;
  const LengthUnit* unit = nullptr;  // null: none is named
};

// Nothing for a text that is no number, alone or with a unit behind; infinite for one that no
// double holds.
std::optional<Length> parse_length(std::string_view text);

// The value of a length with a unit, in units of this size.
double in_units_of(double micrometres, const Length& length);

// The unit that a file states.
struct StatedUnit {
  double micrometres = 0.0;      // of one unit of what read_mesh() or read_cad() makes of the file
  double own_micrometres = 0.0;  // of one unit of the numbers in the file; CAD files: see CadPart
  bool by_format = false;        // the format says so, not the file
};

// For mesh and CAD files. A 3MF file states its unit (by default the millimetre), glTF is in
// metres, DAE is read into metres from its own <unit>, CAD files into millimetres. Nothing for the
// formats that have no units: STL, OBJ, PLY, OFF. Only 3MF and DAE files are opened: throws Error,
// naming the file, for one that cannot be read or whose unit cannot be used.
std::optional<StatedUnit> stated_unit(const std::filesystem::path& path);

}  // namespace spherule
