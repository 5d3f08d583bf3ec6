// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_unit.h"
#include "geometry/mesh_report.h"
#include "simplifier/simplify.h"

#include <string>
#include <vector>

namespace spherule {

// Sentences about lengths that look as if they were meant in another unit than the mesh has, each
// with the likely one: an E above a tenth or below a thousandth of the part's largest extent, a D
// below a tenth of E. None of them stops the work. `options` as requested, 0 where a default is to
// be taken; `unit` that of the output.
std::vector<std::string> length_warnings(const MeshReport& mesh, const SimplifyOptions& options,
                                         const ModelUnit& unit);

}  // namespace spherule
