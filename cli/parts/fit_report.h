// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_file.h"
#include "cli/files/model_unit.h"
#include "cli/text/json.h"
#include "geometry/mesh_report.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/simplify.h"

#include <optional>
#include <string>

namespace spherule {

// What a fit was of: a file, or a body of one.
struct FittedModel {
  const std::string& name;
  const TriangleMesh& mesh;
  const std::optional<CadPart>& cad;
  double scale;
  const MeshReport& report;
};

// What it takes to judge a fit without repeating it: mesh, options, times, the simplified solid
// (box, D, padding, external spheres), history and certificate.
Json to_json(const FittedModel& model, const Simplification& result, ReportContent content);

// The text of REPORT.json: that, the unit, and where the spheres stand.
std::string fit_report(const FittedModel& model, const ModelUnit& unit,
                       const Simplification& result, const CoverBreakdown& breakdown,
                       ReportContent content);

// Where the spheres stand, as a line for a person.
std::string describe(const CoverBreakdown& breakdown);

}  // namespace spherule
