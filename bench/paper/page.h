// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/paper/results.h"

#include <filesystem>

namespace spherule {

// FOLDER/paper.html: the tables, and the plots and pictures beside it, which may be made later.
// The versions of packages are those of FOLDER/packages.txt (machine.h). Throws Error.
void write_page(const PaperResults& results, const std::filesystem::path& folder);

}  // namespace spherule
