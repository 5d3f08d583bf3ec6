// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <string>
#include <vector>

namespace spherule {

// What is said of spheres, and reports of them, whose making was interrupted.
inline constexpr const char* kInterruptedSearch =
    "interrupted: the search was not finished; all that is called proved holds";

// For a D that was chosen larger than 4 E.
std::string larger_diameter_warning(double min_external_diameter);

// Sentences about a fit whose user may have wanted another: a D that became larger than 4 E, a grid
// of stage 1 that is coarser than its E asks for, both as the part is large; spheres of more than
// five times the volume of the mesh.
std::vector<std::string> result_warnings(const Simplification& result);

// Sentences about lengths that look as if they were meant in another unit than the mesh has, each
// with the likely one: an E above a tenth or below a thousandth of the part's largest extent, a D
// below a tenth of E. None of them stops the work. `options` as requested, 0 where a default is to
// be taken; `unit` that of the output.
std::vector<std::string> length_warnings(const MeshReport& mesh, const SimplifyOptions& options,
                                         const ModelUnit& unit);

}  // namespace spherule
