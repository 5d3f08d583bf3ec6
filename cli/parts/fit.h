// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model.h"
#include "cli/options/options.h"
#include "cli/text/json.h"
#include "geometry/mesh_report.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/option_record.h"
#include "simplifier/simplify.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// What the command line of `fit` says.
struct FitArguments {
  std::vector<std::string> models;
  std::string spheres;
  std::string report;
  std::string tree;
  std::string view;
  std::string tool;
  std::string zones;
  std::string levels;
  bool bodies = false;  // CAD files: each of their bodies by itself
  bool each = false;    // a file of spheres for each model; `spheres` is their folder
  bool skips_existing = false;
  Shard shard;  // of the models, with `each`
  ReportContent report_content = ReportContent::kNoExternalSpheres;
  std::string method = method_names().front();
  std::string external = placement_names().front();
  UnitArguments unit;
  ModelReadOptions reading;  // the scale apart
  SimplifyOptions options;
  LengthOptions lengths;
};

void add_fit_options(CLI::App& command, FitArguments& arguments);

// The options of the fit, and in `arguments.reading` those of reading but for the scale, with
// lengths converted to output units and what files of options say filled in. Throws Error.
SimplifyOptions fit_options(FitArguments& arguments, const LengthContext& context);

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

// `fit` of several files, or of the bodies of an assembly. Returns the exit code: kNo if a promise
// about any body is not proved.
int fit_bodies(FitArguments& arguments);

}  // namespace spherule
