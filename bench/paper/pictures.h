// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/report.h"
#include "bench/workload.h"

#include <filesystem>

namespace spherule {

// The paper's figures 2 (packing and bounding spheres), 4 (the pipe in each representation), 5 (the
// robot in spheres) and 9 (the work cell), as files that POV-Ray makes pictures of:
// FOLDER/paper-figure4-mesh.pov and so on. Of the results, figure 2 and the courses are shown.
void write_pictures(const Workload& workload, const PaperResults& results,
                    const std::filesystem::path& folder);

}  // namespace spherule
