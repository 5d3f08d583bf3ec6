// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The paper's table and figures, and what it says without one.

#include "bench/checkers/workload.h"
#include "bench/studies/measure.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// What the paper's table says of a method.
struct PaperRow {
  std::string complexity;
  std::size_t collisions = 0;
  double seconds = 0.0;
};

// A way to represent the work cell, as an engine.
struct Representation {
  std::string method;      // its name in paper.json
  std::string complexity;  // of the workpiece; of everything where everything is simplified
  bool is_conservative = false;
  std::unique_ptr<Checker> checker;
  std::optional<PaperRow> paper = {};
};

// The rows of table I, of a fitted workload: the original meshes first; then the workpiece
// decimated to half, its hull and a convex decomposition, all queried by FCL; packed, voxelised and
// in bounding spheres, by the paper's loop and by ours, against robot and torch as meshes; then all
// in spheres. Packing and voxels stand there as the paper has them and once more so that they
// cover.
std::vector<Representation> make_representations(const Workload& workload);

// A way to make spheres of a mesh that is told how fine they are to be.
struct SphereMethod {
  std::string name;
  // `error` is what the method may err by at most, in the unit of the mesh: the smaller,
  // the more spheres. What the method makes of it is its own business.
  std::function<std::vector<Sphere>(const TriangleMesh& mesh, double error)> make;
};

// Those that are compared: packing, OpenVDB's own, voxels, octree, Hubbard's and medial-axis
// spheres as the literature makes them; the bounding sphere simplification by the paper's loop and
// by ours after stage 1 with D = 4 E; and ours with D = E, at which hardly any part changes
// ("cover-as-is"; the paper's loop without stage 1 is the packing).
std::vector<SphereMethod> sphere_methods();

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

// Figure 2 of the paper: "Sphere packing (33 spheres, left) and bounding sphere simplification (11
// spheres, right)" of a part with concave sections, at the same error. The paper's part is not
// known; ours is a block with slots that no tool of the diameter D gets into. Metres.
struct Figure2 {
  TriangleMesh part;
  double max_error = 0.0;              // E of all
  double min_external_diameter = 0.0;  // D of the bounding spheres
  struct Fit {
    std::string method;
    std::vector<Sphere> spheres;  // inflated: they hold the part
    // Certified upper bound of their protrusion: over the part, or what stage 1 made of it.
    double protrusion = 0.0;
  };
  std::vector<Fit> fits;  // packing, the paper's loop, ours
};

// Throws Error if a fit is not proved.
Figure2 figure_2();

void print_figure_2(const Figure2& figure);

// Of some of the queries.
struct Table1Cells {
  std::size_t queries = 0;
  VerdictCount count = {};  // against the original solids
  double seconds = 0.0;     // for all of them
  double ratio = 0.0;       // of the first row's time
};

struct Table1Row {
  std::string method;
  std::string complexity;
  bool is_conservative = false;
  Table1Cells whole;
  Table1Cells critical;  // the torch at the seams
  std::optional<PaperRow> paper;
};

// Times them in alternating rounds in the program's order and judges their verdicts by the
// original solids.
std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options);

void print_table1(const std::vector<Table1Row>& rows);

// What a query costs in one tree over a set of spheres: collide() up to the first contact, means
// over random poses of a rod near the pipe.
struct TreeCost {
  std::size_t nodes = 0;  // inner ones too
  int depth = 0;
  double node_tests = 0.0;
  double ns = 0.0;
};

// A tree of the literature, and ours over the same leaves. The traversal is the same.
struct TreeRow {
  std::string method;
  std::size_t leaves = 0;
  double collision_percent = 0.0;
  TreeCost own = {};
  TreeCost ours = {};
};

// The paper's pipe by the octree of Liu, Palmer and Grimsdale, by Hubbard's levels and by those of
// the adaptive medial axis, each as its method has it (parents made to enclose their children where
// they do not). Throws Error if a tree and ours answer otherwise.
std::vector<TreeRow> study_trees();

void print_trees(const std::vector<TreeRow>& rows);

// The paper's hollow pipe, in metres: a bore of 40 mm (figure 3) in a wall of 5.9 mm, which makes
// the bore 145 % of the metal's volume (figure 8). Its length is not known.
TriangleMesh make_paper_pipe();
inline constexpr double kPaperBore = 0.040;
// "Voxelised using a 5 mm grid of 5 mm diameter spheres" (section IV.B).
inline constexpr double kPaperVoxel = 0.005;

struct Figure3Row {
  double min_external_diameter = 0.0;
  double uncovered_reachable = 0.0;  // share of the box, by placement
  double uncovered_random = 0.0;
};
// The pipe's box as D grows from a third to more than the bore.
std::vector<Figure3Row> figure_3();

// Figures 6 to 8: the pipe as spheres are added, for one method.
struct FitCourse {
  std::string method;
  std::vector<CoverHistoryEntry> history;
  std::vector<Sphere> spheres;  // of the end, after inflation
};
// Stage 1 with D = 100 mm, then the paper's loop to E = 1 mm.
FitCourse bounding_course();
// The paper's generic packing of the pipe as it is, to the same E.
FitCourse packing_course();

// The share of the box that no external sphere covers (the paper's figure 3), by the centres of
// cells of which `along` lie along the box's longest edge. Errs by the cells that a sphere's
// surface passes.
double uncovered_share(const ExternalSpheres& external, int along);

// The paper's figures 2 (packing and bounding spheres), 4 (the pipe in each representation), 5 (the
// robot in spheres) and 9 (the work cell), as files that POV-Ray makes pictures of:
// FOLDER/paper-figure4-mesh.pov and so on.
void write_pictures(const Workload& workload, const Figure2& figure,
                    const std::vector<FitCourse>& courses, const std::filesystem::path& folder);

}  // namespace spherule
