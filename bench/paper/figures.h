// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/paper/representations.h"
#include "bench/studies/measure.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

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
  double reachable = 0.0;  // share of the box that is not covered, by placement
  double random = 0.0;
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

}  // namespace spherule
