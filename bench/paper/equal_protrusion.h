// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/representations.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace spherule {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

// How many spheres a method needs for a part, if they have to hold it and stick out of it no
// further than all others may.
struct CountEntry {
  std::string method;
  std::size_t spheres = 0;  // 0: none of the settings that were tried does it
  // Of those spheres, or, if there are none, of the last that were made: the certified upper bound
  // of their protrusion over |M|, and what they had to grow by to cover it.
  double protrusion = 0.0;
  double inflation = 0.0;
  double setting = 0.0;  // the error that the method was given
  double seconds = 0.0;  // of making them, without the proof
};

struct CountRow {
  std::string part;
  std::size_t triangles = 0;
  double diagonal = 0.0;
  double max_protrusion = 0.0;
  std::vector<CountEntry> entries;  // one a method
};

// Of every allowed protrusion to the box diagonal.
inline constexpr double kEqualProtrusion = 0.02;

// The fewest spheres of `method` found with five settings that one judge proves to hold |M| and to
// protrude from it by at most `max_protrusion`: made_conservative(), which grows what does not
// cover by itself. A setting that the method or the judge refuses ends the search. (Spheres around
// voxels touch at corners, so they grow too, by 1/4096 of the diagonal.)
CountEntry fewest_spheres(const TriangleMesh& mesh, const SphereMethod& method,
                          double max_protrusion);

// A row of all sphere_methods(); `done` is told of each entry.
CountRow compare_counts(const NamedMesh& part, const std::function<void(const CountEntry&)>& done);

// Closed solids of the project: the paper's pipe, a plate with holes, a bracket.
std::vector<NamedMesh> own_parts();

// Every mesh of MODELS/parts, by name. Throws Error if there is none or one cannot be read.
std::vector<NamedMesh> real_parts(const std::filesystem::path& models);

void print_count(const CountEntry& entry);
void print_counts(const std::vector<CountRow>& rows);

}  // namespace spherule
