// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// STEP and IGES files as meshes, with a bound on how far these are from the faces.
//
// @code{.cpp}
// #include <spherule/io/cad/cad_file.h>
// #include <spherule/base/error.h>
// #include <cassert>
// #include <iostream>
//
// try {
//   const spherule::CadPart part = spherule::read_cad("part.step", {.chord_error = 0.05});  // mm
//   std::cout << part.mesh.triangles.size() << " triangles within " << part.chord_error << " mm\n";
//   assert(part.chord_error <= part.mesh.vertex_error);
// } catch (const spherule::Error& error) {
//   std::cout << error.what() << "\n";  // where there is no such file, or a face cannot be read
// }
// @endcode

#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// How a CAD file becomes triangles.
struct CadReadOptions {
  // Factor from millimetres to the unit of the model (0.001 for metres).
  double scale = 1.0;
  // How far the part may be from its mesh, in the unit of the model: an aim, which is met where up
  // to four tessellations, each finer, can. 0: a two-thousandth of the diagonal of the part's box.
  double chord_error = 0.0;
  // Largest turn between neighbouring pieces of a curve, in radians, for features smaller than the
  // chord error.
  double angle = 0.5;
};

// A face of which the bound is measured, not proved.
struct UnprovedFace {
  std::string name;  // its number in the file's order and its kind
  std::string reason;
};

// A part as triangles, and how far it is from them.
//
// Promise, if `proved`: every point of every face of the part is within chord_error of the mesh,
// and mesh.vertex_error is chord_error plus the rounding of coordinates. The faces are taken as
// OpenCASCADE built them from the file: each surface within the boundary curves in its parameters.
// What the file leaves open between faces, the largest tolerance of their edges and vertices as
// OpenCASCADE stores or measures it, is part of chord_error. Evaluating a surface is taken to err
// by less than 2^-40 of the largest coordinate of mesh, poles and locations or radius, which is
// charged too. So what the simplifier promises for the mesh grown by vertex_error holds for the
// part (docs/cad.md has the proof).
//
// Faces in `unproved` were sampled instead; chord_error then holds twice the largest deviation
// found on them, which is no proof.
struct CadPart {
  TriangleMesh mesh;
  double chord_error = 0.0;  // in the unit of the model, as the next three
  double asked = 0.0;        // the chord error that the tessellation aimed at
  double reached = 0.0;      // deviation found at some point: no bound below it is possible
  double tolerance = 0.0;    // of the edges and vertices; in chord_error
  bool proved = true;
  std::vector<UnprovedFace> unproved;
  std::size_t faces = 0;
  std::size_t free_edges = 0;  // of no face: left out, as lines are in mesh files
  std::string stated_unit;     // of the numbers in the file, as the file names it: "inch"
};

// Reads STEP (AP203, AP214, AP242) and IGES, told apart by the extension (step, stp, iges, igs).
// Lengths come out in millimetres times `scale`,
// whatever the unit of the file, assemblies with their parts in place. Equal input gives equal
// output.
//
// Throws Error, naming file and reason: no such file, not a file of its kind, no faces, a face that
// was not translated or could not be tessellated (named), an entity that is broken, of an unknown
// type or not read (named: solids other than breps, tessellations, documents, scaled copies and all
// that docs/cad.md lists), coordinates beyond kMaxCoordinate, a bad option.
CadPart read_cad(const std::filesystem::path& path, const CadReadOptions& options = {});

// A body of a CAD file: a part as above, or a copy of one.
struct CadBody {
  std::string name;  // by its places in the assembly: "GEARBOX/BOLT:2"; no two are the same
  CadPart part;      // in place; of a copy empty
  // A copy: which body it is a copy of, and the motion from there to its own place. What that
  // motion misses by is in the vertex_error of the other.
  std::optional<BodyCopy> copy = std::nullopt;
};

// The bodies of the file: the parts of a STEP assembly in their places, and of a part of several
// solids each of these. All of them together are what read_cad() reads; but each is tessellated by
// itself, a default chord error being one of its own box. Throws Error as read_cad() does.
std::vector<CadBody> read_cad_bodies(const std::filesystem::path& path,
                                     const CadReadOptions& options = {});

}  // namespace spherule
