// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit_options.h"

#include "cli/files/in_file.h"
#include "cli/help/command_specification.h"
#include "cli/options/check_number.h"
#include "cli/options/search_options.h"
#include "io/sphere_file.h"
#include "simplifier/option_record.h"
#include "simplifier/zone_file.h"

#include <CLI/CLI.hpp>

namespace spherule {

namespace {

void add_model_options(CLI::App& command, FitArguments& arguments) {
  LengthOptions& lengths = arguments.lengths;
  command
      .add_option("mesh", arguments.models,
                  "STL, OBJ, PLY, OFF, DAE, 3MF, glTF, GLB; STEP or IGES. Several become bodies of "
                  "one file, each covered and proved by itself")
      ->required()
      ->type_name(kFile);
  command.add_flag("--bodies", arguments.bodies,
                   "STEP and IGES: every body of an assembly by itself, copies of a part once, in "
                   "one file");
  command
      .add_option(
          "-o,--output", arguments.spheres,
          "Where the spheres go (JSON; default: the name of the first mesh with .json, here); with "
          "--each their folder")
      ->type_name(kFile);
  CLI::Option* each =
      command.add_flag("--each", arguments.each,
                       "Each mesh by itself, into a file of its own: NAME.json. One that cannot be "
                       "read does not end the others");
  command
      .add_flag(
          "--skip-existing", arguments.skips_existing,
          "With --each: leave out meshes whose spheres are there and proved, made with whatever "
          "options, so that a run that was ended goes on")
      ->needs(each);
  add_shard_option(command, "With --each: every N-th mesh, the I-th of each N, for batch systems",
                   arguments.shard)
      ->needs(each);
  add_unit_options(command, arguments.unit,
                   "Output units per mesh unit (of STEP and IGES: per millimetre)");
  lengths.add(command, "--weld", arguments.reading.weld,
              "Join vertices that are no further apart, so that cracks which rounding has left "
              "do not open the mesh; added to the padding");
  lengths.add(command, "--chord-error", arguments.reading.chord_error,
              "STEP and IGES: how far the part may be from its triangles; what is proved of it "
              "is added to the padding (default: a two-thousandth of the box diagonal)");
}

void add_promise_options(CLI::App& command, FitArguments& arguments) {
  SimplifyOptions& options = arguments.options;
  LengthOptions& lengths = arguments.lengths;
  auto* diameter = lengths.add(
      command, "--min-external", options.min_external_diameter,
      "D, diameter of the smallest object to be checked against the model (default: 4 "
      "E, more where a part is so large that this would take too much memory). With E "
      "/ 2 or less only gaps narrower than that are filled: the method without stage 1");
  command
      .add_option(
          "--tool", arguments.tool,
          "D from the tool that is checked against the model: the smallest of these spheres (JSON)")
      ->type_name(kFile)
      ->excludes(diameter);
  command
      .add_option("--tightness", options.tightness,
                  "How much wider than D a way in may be and still be filled, as a share of D "
                  "(default: 0.03); less takes longer")
      ->check(CLI::Range(0.001, ExternalOptions::kNoTightness));
  command
      .add_option("--zones", arguments.zones,
                  "Where E and D are smaller: spheres, boxes and capsules (JSON)")
      ->type_name(kFile);
  command.add_flag("--keep-concave-edges", options.keep_concave_edges,
                   "A smaller D along sharp concave edges, so that they are not filled");
  lengths.add(command, "--max-error", options.max_error,
              "E, how far the spheres may protrude (default: 1 % of the box diagonal)");
  lengths.add(command, "--padding", options.padding, "Grow the mesh by this much");
  lengths.add(command, "--min-radius", options.min_radius, "No sphere is smaller than this");
}

void add_method_options(CLI::App& command, FitArguments& arguments) {
  SimplifyOptions& options = arguments.options;
  command
      .add_option("--method", arguments.method,
                  "How the inside is covered: cover (fewest spheres) or paper (the paper's loop)")
      ->check(CLI::IsMember(method_names()));
  command
      .add_option("--external", arguments.external,
                  "How external spheres are placed: reachable, random, none")
      ->check(CLI::IsMember(placement_names()));
  command
      .add_option("--external-limit", options.external_limit, "Attempts of the random placement")
      ->check(check_not_negative);
  arguments.lengths.add(command, "--min-internal", options.min_internal_diameter,
                        "Diameter at which paper seeds a sphere (default: E / 2)");
  command
      .add_option("--levels", arguments.levels,
                  "Fit coarser levels of detail too and join all in one tree; the "
                  "finest is E")
      ->type_name("E1,E2,...");
  add_search_options(
      command, {options.seed, options.effort, options.seconds, options.threads},
      "With cover: rounds at most of searching for fewer spheres than at first, fewer where more "
      "would not pay; 0: none",
      "With cover: search for fewer spheres for so long, less where it no longer finds any; the "
      "result then depends on the machine");
}

void add_output_options(CLI::App& command, FitArguments& arguments) {
  command
      .add_option("--report", arguments.report,
                  "Where the report goes (JSON): the mesh, where the spheres go, history, times")
      ->type_name(kFile);
  add_external_spheres_flag(command, arguments.report_content);
  command.add_flag(
      "--lower-bound", arguments.options.lower_bound,
      "Prove, too, how few spheres any cover must have (with cover, up to some 8,000 "
      "spheres, without --min-radius); takes tens of times as long as the first answer");
  command.add_option("--tree", arguments.tree, "Where the sphere tree goes")->type_name(kFile);
  command.add_option("--view", arguments.view, "Where a page to examine goes (HTML)")
      ->type_name(kFile);
}

}  // namespace

void add_fit_options(CLI::App& command, FitArguments& arguments) {
  add_model_options(command, arguments);
  add_promise_options(command, arguments);
  add_method_options(command, arguments);
  add_output_options(command, arguments);
}

SimplifyOptions fit_options(FitArguments& arguments, const LengthContext& context) {
  arguments.lengths.convert(context);
  SimplifyOptions options = arguments.options;
  options.method = method_named(arguments.method);
  options.external = placement_named(arguments.external);
  if (!arguments.levels.empty()) {
    options.levels = lengths_in(arguments.levels, "--levels", context);
  }
  options.history = !arguments.report.empty();
  if (!arguments.zones.empty()) options.zones = read_zones(arguments.zones);
  if (!arguments.tool.empty()) {
    const SphereFile tool = load_spheres(arguments.tool);
    const double diameter =
        blame_named_file(arguments.tool, "tool", [&] { return tool_diameter(tool.spheres); });
    const std::string units =
        blame_named_file(arguments.tool, "units", [&] { return stored_reading(tool).units; });
    options.min_external_diameter =
        converted({diameter, unit_named(units)}, "--tool " + arguments.tool, context);
  }
  return options;
}

}  // namespace spherule
