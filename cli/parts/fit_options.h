// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_file.h"
#include "cli/files/model_unit.h"
#include "cli/options/external_spheres_flag.h"
#include "cli/options/length_options.h"
#include "cli/options/shard.h"
#include "simplifier/simplify.h"

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

}  // namespace spherule
