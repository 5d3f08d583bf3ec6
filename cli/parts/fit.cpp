// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/view_page.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "io/sphere_file.h"
#include "simplifier/option_record.h"
#include "simplifier/zone_file.h"
#include "spheretree/build.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

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

Json to_json(const std::string& file, const TriangleMesh& mesh, const MeshReport& report) {
  return {{"file", file},
          {"vertices", report.vertices},
          {"triangles", report.triangles},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"misoriented_edges", report.misoriented_edges},
          {"components", report.components},
          {"inverted_components", report.inverted_components},
          {"self_intersections", report.self_intersections},
          {"self_intersections_stopped", report.self_intersections_stopped},
          {"closed", report.closed},
          {"box", spherule::to_json(report.box)},
          {"area", report.area},
          {"volume", report.volume},
          {"vertex_error", mesh.vertex_error}};
}

Json to_json(const CoverHistoryEntry& entry) {
  return {{"sphere_count", entry.sphere_count},
          {"max_error", spherule::to_json(Bounds{.lower = entry.max_error_lower,
                                                 .upper = entry.max_error_upper})},
          {"surface_error_before", spherule::to_json(entry.surface_error_before)},
          {"surface_error_after", spherule::to_json(entry.surface_error_after)},
          {"coverage_before", entry.coverage_before},
          {"coverage_after", entry.coverage_after},
          {"excess_before", entry.excess_before},
          {"excess_after", entry.excess_after}};
}

Json to_json(const SphereCover& cover) {
  Json json = Json::object();
  json["lower_bound"] = cover.lower_bound > 0 ? Json(cover.lower_bound) : Json(nullptr);
  json["inflation"] = spherule::to_json(cover.inflation);
  json["seeds_rejected"] = cover.seeds_rejected;
  json["spheres_before_inflation"] = spherule::to_json(cover.spheres_before_inflation);
  json["history"] = Json::array();
  for (const CoverHistoryEntry& entry : cover.history) json["history"].push_back(to_json(entry));
  return json;
}

Json to_json(std::span<const CoverLevel> levels) {
  Json list = Json::array();
  for (const CoverLevel& level : levels) {
    list.push_back({{"max_error", level.max_error},
                    {"sphere_count", level.spheres.spheres.size()},
                    {"protrusion_over_simplified_max", level.protrusion},
                    {"clustering",
                     {{"sphere_count", level.clustering_count},
                      {"protrusion_over_simplified_max", level.clustering_protrusion}}},
                    {"parent_of_finer", level.spheres.parent_of},
                    {"spheres", spherule::to_json(level.spheres.spheres)}});
  }
  return list;
}

Json to_json(const CoverBreakdown& breakdown) {
  return {{"spheres_by_role",
           {{"edges", breakdown.edges},
            {"thin", breakdown.thin},
            {"faces", breakdown.faces},
            {"inside", breakdown.inside}}}};
}

std::string number(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

// Of the bodies that are no copies.
std::vector<std::optional<MeshReport>> reports_of(const ModelBodies& model) {
  std::vector<std::optional<MeshReport>> reports;
  for (const Body& body : model.bodies) {
    reports.push_back(body.copy
                          ? std::nullopt
                          : std::optional(mesh_report(body.mesh, {.self_intersections = false})));
  }
  return reports;
}

// What of lengths looks wrong for the bodies together, and which are open.
void warn_of_bodies(const ModelBodies& model, const std::vector<std::optional<MeshReport>>& reports,
                    const SimplifyOptions& options, const ModelUnit& unit,
                    const std::string& name) {
  MeshReport all;
  std::size_t open = 0;
  std::string first_open;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (!reports[i]) continue;
    all.box.extend(reports[i]->box);
    if (reports[i]->closed) continue;
    if (open++ == 0) first_open = model.bodies[i].name;
  }
  warn_each(name, length_warnings(all, options, unit));
  if (open > 0) {
    tell(std::to_string(open) + (open == 1 ? " body is" : " bodies are") +
         " not closed: only the surface is certain (" + first_open +
         (open > 1 ? " is the first" : "") + ")");
  }
}

// A row a body, and their sums.
std::string table(const ModelBodies& model, std::span<const BodyFit> fits, double seconds) {
  std::vector<std::vector<std::string>> rows = {
      {"body", "triangles", "spheres", "protrusion", "seconds", "proved"}};
  std::size_t copies = 0;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  double largest = 0.0;
  bool is_proved = true;
  bool is_interrupted = false;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const std::optional<BodyCopy>& copy = model.bodies[i].copy;
    const std::size_t own = model.bodies[copy ? copy->of : i].mesh.triangles.size();
    const double protrusion = fits[i].certificate.protrusion_over_simplified_max.value_or(0.0);
    rows.push_back({model.bodies[i].name, std::to_string(own),
                    std::to_string(fits[i].spheres.size()), number(protrusion, 4),
                    copy ? "copy of " + model.bodies[copy->of].name : number(fits[i].seconds, 3),
                    std::string(fits[i].broken.empty() ? "yes" : "no") +
                        (fits[i].interrupted ? " (interrupted)" : "")});
    is_interrupted = is_interrupted || fits[i].interrupted;
    copies += copy ? 1 : 0;
    triangles += own;
    spheres += fits[i].spheres.size();
    largest = std::max(largest, protrusion);
    is_proved = is_proved && fits[i].broken.empty();
  }
  std::string all = std::to_string(fits.size()) + " bodies";
  if (copies > 0) all += ", " + std::to_string(copies) + " of them copies";
  rows.push_back({all, std::to_string(triangles), std::to_string(spheres), number(largest, 4),
                  number(seconds, 3), is_proved ? "yes" : "no"});
  return aligned(rows) + (is_interrupted ? std::string(kInterruptedSearch) + "\n" : "");
}

std::string report_text(const ModelBodies& model,
                        const std::vector<std::optional<MeshReport>>& reports,
                        std::span<const BodyFit> fits, const ModelUnit& unit,
                        ReportContent content) {
  Json json = Json::object();
  json["format"] = "spherule-bodies-report";
  json["version"] = 1;
  json["unit"] = to_json(unit);
  json["bodies"] = Json::array();
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const Body& body = model.bodies[i];
    Json one = Json::object();
    if (fits[i].fit) {
      one = to_json({body.name, body.mesh, model.cad[i], model.scales[i], *reports[i]},
                    *fits[i].fit, content);
    }
    one["name"] = body.name;
    one["sphere_count"] = fits[i].spheres.size();
    one["total_seconds"] = fits[i].seconds;
    one["broken_promises"] = fits[i].broken;
    if (fits[i].interrupted) json["interrupted"] = one["interrupted"] = true;
    if (body.copy) one["copy_of"] = body.copy->of;
    json["bodies"].push_back(std::move(one));
  }
  return to_text(json, Layout::kCompact);
}

SphereFile stored(const FitArguments& arguments, const ModelBodies& model,
                  std::span<const BodyFit> fits) {
  SphereFile file = sphere_file(model.bodies, fits, model.scales);
  // What it takes to read the same bodies again.
  const ModelReadOptions& reading = arguments.reading;
  if (arguments.unit.scale) file.options["scale"] = *arguments.unit.scale;
  if (!reading.units.empty()) file.options["units"] = reading.units;
  if (reading.chord_error > 0.0) file.options["chord-error"] = reading.chord_error;
  if (reading.weld > 0.0) file.options["weld"] = reading.weld;
  if (arguments.bodies) file.options["bodies"] = true;
  return file;
}

void write_view(const FitArguments& arguments, const ModelBodies& model, const SphereFile& file,
                const std::optional<SphereTree>& tree) {
  ViewScene scene{.title = arguments.models.front(), .items = {}};
  ViewItem meshes{.name = "bodies", .parts = {}};
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    meshes.parts.push_back({mesh_of(model, i)});
  }
  scene.items.push_back(std::move(meshes));
  const ViewContent spheres = tree ? ViewContent(*tree) : ViewContent(file.spheres);
  scene.items.push_back({.name = arguments.spheres, .parts = {{spheres}}});
  write_file_atomically(arguments.view, make_view_page(scene));
}

std::vector<NextStep> next_steps(const FitArguments& arguments) {
  std::vector<std::string> audit = {"audit"};
  audit.insert(audit.end(), arguments.models.begin(), arguments.models.end());
  audit.push_back(arguments.spheres);
  std::vector<NextStep> steps = {{std::move(audit), "prove it again"}};
  if (arguments.tree.empty()) {
    steps.push_back({{"tree", arguments.spheres, "-o", beside(arguments.spheres, ".tree")},
                     "one for all, for collision checks"});
  }
  return steps;
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

Json to_json(const FittedModel& model, const Simplification& result, ReportContent content) {
  Json json = Json::object();
  json["mesh"] = to_json(model.name, model.mesh, model.report);
  if (model.cad) json["cad"] = to_json(*model.cad);
  json["options"] = to_json(option_record(result.options, model.scale));
  json["seconds"] = {{"external", result.times.external},
                     {"cover", result.times.cover},
                     {"levels", result.times.levels},
                     {"certify", result.times.certify}};
  json["certificate"] = to_json(result.certificate);
  json["simplified_solid"] = to_json(result.external, content);
  json["cover"] = to_json(result.cover);
  json["levels"] = to_json(result.levels);
  if (result.interrupted) json["interrupted"] = true;
  return json;
}

std::string fit_report(const FittedModel& model, const ModelUnit& unit,
                       const Simplification& result, const CoverBreakdown& breakdown,
                       ReportContent content) {
  Json json = to_json(model, result, content);
  json["format"] = "spherule-report";
  json["version"] = 1;
  json["unit"] = to_json(unit);
  json["analysis"] = to_json(breakdown);
  // Indented, hundreds of thousands of external spheres would take three times the room.
  return to_text(json, Layout::kCompact);
}

std::string describe(const CoverBreakdown& breakdown) {
  std::ostringstream out;
  out << "where the spheres go: " << breakdown.edges << " along sharp edges, " << breakdown.thin
      << " in thin parts, " << breakdown.faces << " on faces, " << breakdown.inside << " inside\n";
  return out.str();
}

int fit_bodies(FitArguments& arguments) {
  for (const std::string& model : arguments.models) {
    check_outputs({arguments.spheres, arguments.report, arguments.tree, arguments.view},
                  {model, arguments.tool});
  }
  if (!arguments.zones.empty()) throw Error("--zones", "are of one body, not of several");
  if (!arguments.levels.empty()) throw Error("--levels", "are of one body, not of several");
  std::vector<ModelUnit> units = model_units(arguments.models, arguments.unit);
  SimplifyOptions options = fit_options(arguments, length_context(arguments.models, units));
  arguments.reading.units = symbol_of(units.front());

  ProgressBar bar;
  bar.announce("reading");
  const ModelBodies model =
      read_bodies(arguments.models, units, arguments.reading, arguments.bodies);
  const std::vector<std::optional<MeshReport>> reports = reports_of(model);
  bar.clear();
  if (model.cad.front()) note_cad_unit(model.cad.front()->stated_unit, units.front());
  std::cout << describe(units.front()) << std::flush;
  warn_of_bodies(model, reports, options, units.front(), arguments.models.front());

  StopOnInterruption interruption;
  options.on_proved = [&](std::size_t) { interruption.have_answer(); };
  options.stop = interruption.token();
  options.progress = bar.callback();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<BodyFit> fits = fit_bodies(model.bodies, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bar.clear();

  const SphereFile file = stored(arguments, model, fits);
  write_uninterrupted([&] {
    save_spheres(file, arguments.spheres);
    if (!arguments.report.empty()) {
      write_file_atomically(arguments.report, report_text(model, reports, fits, units.front(),
                                                          arguments.report_content));
    }
    std::optional<SphereTree> tree;
    if (!arguments.tree.empty() || !arguments.view.empty()) tree = build_tree(file.spheres);
    if (!arguments.tree.empty()) save_tree(*tree, arguments.tree);
    if (!arguments.view.empty()) write_view(arguments, model, file, tree);
  });
  std::cout << table(model, fits, seconds.count())
            << (arguments.each ? "" : describe(next_steps(arguments)));
  bool is_proved = true;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    is_proved = is_proved && !(model.cad[i] && !model.cad[i]->proved);
    if (fits[i].fit) warn_each(model.bodies[i].name, result_warnings(*fits[i].fit));
    if (fits[i].broken.empty()) continue;
    is_proved = false;
    tell(arguments.spheres + ": " + model.bodies[i].name + ": " + fits[i].broken);
  }
  return is_proved ? kYes : kNo;
}

}  // namespace spherule
