// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_unit.h"
#include "mesh/mesh_report.h"
#include "simplifier/simplify.h"

#include <string>
#include <vector>

namespace spherule {

// Sentences about lengths that look as if they were meant in another unit than the mesh has, each
// with the likely one. None of them stops the work.

// Before it: an E above a tenth of the part's largest extent, a D below a tenth of E. `options` as
// requested, 0 where a default is to be taken; `unit` that of the output.
std::vector<std::string> length_warnings(const MeshReport& mesh, const SimplifyOptions& options,
                                         const ModelUnit& unit);

// After it: a grid of stage 1 that is coarser than its E asks for, as the part is large; spheres of
// more than five times the volume of the mesh.
std::vector<std::string> result_warnings(const Simplification& result);

}  // namespace spherule
