// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/model_file.h"
#include "cli/model_unit.h"
#include "cli/report_content.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/mesh_report.h"
#include "simplifier/simplify.h"

#include <string>

namespace spherule {

// The text of REPORT.json: everything that is needed to judge a fit without repeating it: mesh,
// options, times, the simplified solid (box, D, padding, external spheres), history, certificate,
// and where the spheres stand.
// `mesh_file` is named in it; `scale` is the one the mesh was read with.
std::string fit_report(const std::string& mesh_file, const ModelFile& model, const ModelUnit& unit,
                       const MeshReport& report, const Simplification& result,
                       const CoverBreakdown& breakdown, ReportContent content);

// Where the spheres stand, as a line for a person.
std::string describe(const CoverBreakdown& breakdown);

}  // namespace spherule
