// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/results.h"

#include <filesystem>

namespace spherule {

// FOLDER/paper.json, FOLDER/paper-table1.csv, FOLDER/paper-counts.csv and, for the plots, a file
// for figure 3 and one for the courses. Throws Error.
void write_paper(const PaperResults& results, const std::filesystem::path& folder);

}  // namespace spherule
