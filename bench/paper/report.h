// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/claims.h"
#include "bench/paper/figures.h"
#include "bench/paper/table1.h"

#include <filesystem>
#include <vector>

namespace spherule {

struct PaperResults {
  std::vector<Table1Row> table1;
  std::vector<Figure3Row> figure_3;
  std::vector<FitCourse> courses;  // figures 6 to 8
  std::vector<ClaimRow> claims;
};

// The paper's figures 4 (the pipe in each representation), 5 (the robot in spheres) and 9 (the work
// cell), as files that POV-Ray makes pictures of: FOLDER/paper-figure4-mesh.pov and so on.
void write_pictures(const Workload& workload, const std::vector<FitCourse>& courses,
                    const std::filesystem::path& folder);

// FOLDER/paper.json, FOLDER/paper-table1.csv and, for the plots, a file for figure 3 and one for
// the courses. Throws Error.
void write_paper(const PaperResults& results, const std::filesystem::path& folder);

}  // namespace spherule
