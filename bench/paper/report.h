// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/claims.h"
#include "bench/paper/equal_protrusion.h"
#include "bench/paper/figure2.h"
#include "bench/paper/figures.h"
#include "bench/paper/table1.h"
#include "bench/paper/trees.h"

#include <filesystem>
#include <vector>

namespace spherule {

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
