// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/equal_protrusion.h"
#include "bench/paper/figures.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// What the paper says without a figure: a shape in spheres at equal E, with stage 1 and with a D so
// small that nothing of the shape vanishes. Lengths in metres.
struct ClaimRow {
  std::string shape;
  int holes = 0;
  std::size_t triangles = 0;
  double max_error = 0.0;
  double min_external_diameter = 0.0;  // with stage 1
  std::size_t with_stage1 = 0;         // spheres
  std::size_t without_stage1 = 0;
  // A rod 20 mm across at a hundredth of the size from it: time of the fastest FCL setting on the
  // meshes over ours on the spheres with stage 1.
  double ratio = 0.0;
};

// "The performance increases are most dramatic on CAD models that contain many small features":
// a plate with 0 to 200 holes. "Sphere packing is not suited to models which are long, wide and
// narrow such as a thin plate": thinner ones, of few triangles. "At its worst case performs no
// differently than sphere packing": a cube, of which stage 1 changes nothing. Throws Error if a fit
// is not proved.
std::vector<ClaimRow> study_claims();

void print_claims(const std::vector<ClaimRow>& rows);

// All that `bench/run --paper` computes.
struct PaperResults {
  std::vector<Table1Row> table1;
  Figure2 figure_2;
  std::vector<Figure3Row> figure_3;
  std::vector<FitCourse> courses;  // figures 6 to 8
  std::vector<ClaimRow> claims;
  std::vector<CountRow> counts;
  std::vector<TreeRow> trees;
};

// FOLDER/paper.json, of which bench/plots/plot.py makes the page. Throws Error.
void write_paper(const PaperResults& results, const std::filesystem::path& folder);

}  // namespace spherule
