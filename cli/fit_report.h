// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/cover_analysis.h"
#include "cli/model_file.h"
#include "simplifier/mesh_report.h"
#include "simplifier/simplify.h"

#include <string>

namespace spherule {

// The text of REPORT.json: everything that is needed to judge a fit without repeating it: mesh,
// options, times, the simplified solid (box, D, padding, external spheres), history, certificate.
// `mesh_file` is named in it; `scale` is the one the mesh was read with.
std::string fit_report(const std::string& mesh_file, const ModelFile& model,
                       const MeshReport& report, const Simplification& result,
                       const CoverAnalysis& analysis, double scale);

}  // namespace spherule
