// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/view_page.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/option_record.h"
#include "simplifier/simplify.h"
#include "simplifier/types/zones.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

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

// What a fit was of: a file, or a body of one.
struct FittedModel {
  const std::string& name;
  const TriangleMesh& mesh;
  const std::optional<CadPart>& cad;
  double scale;
  const MeshReport& report;
};

void add_model_options(CLI::App& command, FitArguments& arguments) {
  LengthOptions& lengths = arguments.lengths;
  add_file_argument(command, "mesh", arguments.models,
                    "STL, OBJ, PLY, OFF, DAE, 3MF, glTF, GLB; STEP or IGES. Several become bodies "
                    "of one file, each covered and proved by itself");
  command.add_flag(
      "--bodies", arguments.bodies,
      "STEP and IGES: every body of an assembly by itself, copies of a part once, in one file");
  add_file(command, "-o,--output", arguments.spheres,
           "Where the spheres go (JSON; default: the name of the first mesh with .json, here); "
           "with --each their folder");
  CLI::Option* each = command.add_flag("--each", arguments.each,
                                       "Each mesh by itself, into a file of its own: NAME.json. "
                                       "One that cannot be read does not end the others");
  command
      .add_flag("--skip-existing", arguments.skips_existing,
                "With --each: leave out meshes whose spheres are there and proved, made with "
                "whatever options, so that a run that was ended goes on")
      ->needs(each);
  add_shard_option(command, "With --each: every N-th mesh, the I-th of each N, for batch systems",
                   arguments.shard)
      ->needs(each);
  add_unit_options(command, arguments.unit,
                   "Output units per mesh unit (of STEP and IGES: per millimetre)");
  lengths.add(command, "--weld", arguments.reading.weld,
              "Join vertices that are no further apart, so that cracks which rounding has left do "
              "not open the mesh; added to the padding");
  lengths.add(command, "--chord-error", arguments.reading.chord_error,
              "STEP and IGES: how far the part may be from its triangles; what is proved of it is "
              "added to the padding (default: a two-thousandth of the box diagonal)");
}

void add_promise_options(CLI::App& command, FitArguments& arguments) {
  SimplifyOptions& options = arguments.options;
  LengthOptions& lengths = arguments.lengths;
  auto* diameter = lengths.add(
      command, "--min-external", options.min_external_diameter,
      "D, diameter of the smallest object to be checked against the model (default: 4 E, more "
      "where a part is so large that this would take too much memory). With E / 2 or less only "
      "gaps narrower than that are filled: the method without stage 1");
  add_file(
      command, "--tool", arguments.tool,
      "D from the tool that is checked against the model: the smallest of these spheres (JSON)")
      ->excludes(diameter);
  command
      .add_option("--tightness", options.tightness,
                  "How much wider than D a way in may be and still be filled, as a share of D "
                  "(default: 0.03); less takes longer")
      ->check(CLI::Range(0.001, ExternalOptions::kNoTightness));
  add_file(command, "--zones", arguments.zones,
           "Where E and D are smaller: spheres, boxes and capsules (JSON)");
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
                  "Fit coarser levels of detail too and join all in one tree; the finest is E")
      ->type_name("E1,E2,...");
  add_search_options(command, {options.seed, options.effort, options.seconds, options.threads},
                     "With cover: rounds at most of searching for fewer spheres than at first, "
                     "fewer where more would not pay; 0: none",
                     "With cover: search for fewer spheres for so long, less where it no longer "
                     "finds any; the result then depends on the machine");
}

void add_output_options(CLI::App& command, FitArguments& arguments) {
  add_file(command, "--report", arguments.report,
           "Where the report goes (JSON): the mesh, where the spheres go, history, times");
  add_external_spheres_flag(command, arguments.report_content);
  command.add_flag(
      "--lower-bound", arguments.options.lower_bound,
      "Prove, too, how few spheres any cover must have (with cover, up to some 8,000 spheres, "
      "without --min-radius); takes tens of times as long as the first answer");
  add_file(command, "--tree", arguments.tree, "Where the sphere tree goes");
  add_file(command, "--view", arguments.view, "Where a page to examine goes (HTML)");
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

Json to_json(const FittedModel& model, const Simplification& result, ReportContent content) {
  Json json = Json::object();
  json["mesh"] = to_json(model.name, model.mesh, model.report);
  if (model.cad) json["cad"] = to_json(*model.cad);
  json["options"] = spherule::to_json(option_record(result.options, model.scale));
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

// Of the box diagonal: how far apart rounding leaves what was one vertex.
constexpr double kCrack = 1e-6;

// Thin walls need many spheres: there the count goes with the area, however thin they are.
void warn_of_thin_parts(const FitArguments& arguments, const TriangleMesh& mesh,
                        const Simplification& result) {
  const std::size_t count = result.cover.spheres.size();
  if (count <= mesh.triangles.size()) return;
  const double max_error = result.options.max_error;
  const std::size_t thin = spheres_in_thin_parts(result.external, result.cover.spheres, max_error);
  if (2 * thin <= count) return;
  warn(concat(arguments.models.front(), ": ", thin, " of ", count,
              " spheres stand where the part is thinner than 2 E, and the mesh has only ",
              mesh.triangles.size(), " triangles: thin parts need many spheres. Far fewer would ",
              "do with --max-error ", 2.0 * max_error));
}

std::vector<NextStep> next_steps(const FitArguments& arguments, bool is_covered) {
  std::vector<NextStep> steps;
  if (!is_covered) {
    steps.push_back({{"audit", arguments.models.front(), arguments.spheres, "--repair",
                      beside(arguments.spheres, ".mended.json")},
                     "make them cover"});
  }
  // `view` reads the mesh as it is: the page would hold it in another unit, or other triangles.
  const ModelReadOptions& reading = arguments.reading;
  const bool is_read_plainly = (reading.scale == 1.0 || !arguments.unit.scale) &&
                               reading.chord_error == 0.0 && reading.weld == 0.0;
  if (arguments.view.empty() && is_read_plainly) {
    std::vector<std::string> view = {"view", arguments.models.front(), arguments.spheres};
    if (reading.scale != 1.0) view.insert(view.end(), {"--units", arguments.unit.units});
    view.insert(view.end(), {"-o", beside(arguments.spheres, ".html")});
    steps.push_back({std::move(view), "examine them"});
  }
  if (arguments.tree.empty()) {
    steps.push_back({{"tree", arguments.spheres, "-o", beside(arguments.spheres, ".tree")},
                     "for collision checks"});
  }
  return steps;
}

void print_reading(const std::string& file, const ModelFile& model, const ModelReadOptions& options,
                   ModelUnit& unit, const MeshReport& report) {
  if (model.cad) {
    note_cad_unit(model.cad->stated_unit, unit);
    std::cout << describe(*model.cad);
  }
  std::cout << describe(unit) << describe(report) << std::endl;
  if (report.boundary_edges == 0 || model.cad || options.weld > 0.0) return;
  tell(concat("if rounding has left cracks in ", file, ", --weld ",
              kCrack * report.box.diagonal().norm(), " shuts them"));
}

// The report, and where the spheres go if that is known, for a person.
std::string describe_fit(const std::string& file, const Json& report, const Json& breakdown,
                         const Simplification& result) {
  const bool is_reachable = result.options.external == ExternalPlacement::kReachable;
  const ExternalSpheres& external = result.external;
  std::string text =
      lines(report, {{"",
                      "options: max error {options.max-error}, min external diameter "
                      "{options.min-external}, padding {simplified_solid.padding}"},
                     {"cad", " (chord error and rounding of the file included)\n"},
                     {"!cad", " (rounding of the file included)\n"},
                     {"", "external spheres: {simplified_solid.external_sphere_count}"}});
  if (is_reachable) {
    text += filled(
        ", ways into the part that are wider than {options.min-external} by "
        "{simplified_solid.closing_slack} stay open (proved)",
        report);
  }
  text += "\n";
  if (result.options.keep_concave_edges) {
    text += concat("zones along sharp concave edges: ", external.concave_edges.size(), "\n");
  }
  text += concat(one_line(file), ": ", result.cover.spheres.size(), " spheres\n",
                 result.interrupted ? std::string(kInterruptedSearch) + "\n" : "",
                 describe_certificate(report["certificate"], "the simplified solid"));
  for (const Json& level : report["levels"]) {
    text += filled(
        "level {max_error}: {sphere_count} spheres, protrusion over the simplified solid at most "
        "{protrusion_over_simplified_max} (plain clustering: {clustering.sphere_count} spheres, "
        "{clustering.protrusion_over_simplified_max})\n",
        level);
  }
  text += lines(
      breakdown,
      {{"spheres_by_role",
        "where the spheres go: {spheres_by_role.edges} along sharp edges, {spheres_by_role.thin} "
        "in thin parts, {spheres_by_role.faces} on faces, {spheres_by_role.inside} inside\n"}});
  if (result.options.lower_bound) {
    text +=
        lines(report["cover"],
              {{"lower_bound", "lower bound: no cover at this error has fewer than {} spheres\n"},
               {"!lower_bound", "lower bound: not known (see spherule fit --help)\n"}});
  }
  return text +
         filled("seconds: external {external}, cover {cover}, levels {levels}, certify {certify}\n",
                report["seconds"]);
}

// The sphere tree, and the page with these meshes, where they were requested; of `fit`, if there is
// one, with its external spheres and levels.
void write_tree_and_page(const FitArguments& arguments, ViewItem meshes, const Simplification* fit,
                         std::span<const Sphere> spheres) {
  if (arguments.tree.empty() && arguments.view.empty()) return;
  SphereTree tree = fit != nullptr ? sphere_tree(*fit) : build_tree(spheres);
  if (!arguments.tree.empty()) save_tree(tree, arguments.tree);
  if (arguments.view.empty()) return;
  ViewScene scene{.title = arguments.models.front(), .items = {std::move(meshes)}};
  if (fit != nullptr) {
    scene.items.push_back({.name = "external spheres",
                           .parts = {{fit->external.spheres}},
                           .external = true,
                           .shown = false});
  }
  scene.items.push_back({.name = arguments.spheres, .parts = {{std::move(tree)}}});
  write_file_atomically(arguments.view, make_view_page(scene));
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

// `fit` of several files, or of the bodies of an assembly. Returns the exit code: kNo if a promise
// about any body is not proved.
int fit_bodies(FitArguments& arguments) {
  if (!arguments.zones.empty()) throw Error("--zones", "are of one body, not of several");
  if (!arguments.levels.empty()) throw Error("--levels", "are of one body, not of several");
  std::vector<ModelUnit> units = model_units(arguments.models, arguments.unit);
  SimplifyOptions options =
      fit_options(arguments, length_context(arguments.models.front(), units.front()));
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
    ViewItem meshes{.name = "bodies", .parts = {}};
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
      meshes.parts.push_back({mesh_of(model, i)});
    }
    write_tree_and_page(arguments, std::move(meshes), nullptr, file.spheres);
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

// Fails (kNo) if a promise about the spheres is not proved; the files are written nevertheless and
// say so.
int fit(FitArguments& arguments) {
  if (arguments.spheres.empty()) {
    arguments.spheres = default_output(arguments.models.front(), ".json", FileKind::kSpheres);
  }
  std::vector<fs::path> inputs(arguments.models.begin(), arguments.models.end());
  inputs.insert(inputs.end(), {arguments.tool, arguments.zones});
  check_outputs({arguments.spheres, arguments.report, arguments.tree, arguments.view}, inputs);
  if (arguments.models.size() > 1 || arguments.bodies) return fit_bodies(arguments);
  const std::string& file = arguments.models.front();
  ModelUnit unit = model_unit(file, arguments.unit);
  SimplifyOptions options = fit_options(arguments, length_context(file, unit));
  ModelReadOptions& read_options = arguments.reading;
  read_options.scale = unit.scale;
  read_options.units = symbol_of(unit);

  ProgressBar reading;
  reading.announce("reading");
  const ModelFile model = read_model(file, read_options);
  const TriangleMesh& mesh = model.mesh;
  const MeshReport report = mesh_report(mesh);
  reading.clear();
  print_reading(file, model, read_options, unit, report);

  warn_each(file, length_warnings(report, options, unit));
  StopOnInterruption interruption;
  options.on_proved = [&](std::size_t) { interruption.have_answer(); };
  options.stop = interruption.token();
  const Simplification result = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    return blame_named_file(arguments.zones, "zone ", [&] {
      return blame_named_file(file, "grid step", [&] { return simplify(mesh, options); });
    });
  }();

  // First of all what was requested and is proved.
  write_uninterrupted([&] {
    SphereFile spheres = sphere_file(result, unit.scale);
    store_reading(read_options, model, spheres);
    save_spheres(spheres, arguments.spheres);
  });
  Json json =
      to_json({file, mesh, model.cad, unit.scale, report}, result, arguments.report_content);
  Json breakdown;
  if (!arguments.report.empty()) {
    breakdown = to_json(cover_breakdown(mesh, result.external, result.cover.spheres,
                                        result.options.max_error, options.threads));
  }
  write_uninterrupted([&] {
    if (!arguments.report.empty()) {
      json["format"] = "spherule-report";
      json["version"] = 1;
      json["unit"] = to_json(unit);
      json["analysis"] = breakdown;
      // Indented, hundreds of thousands of external spheres would take three times the room.
      write_file_atomically(arguments.report, to_text(json, Layout::kCompact));
    }
    write_tree_and_page(arguments, {.name = file, .parts = {{mesh}}}, &result, {});
  });
  std::cout << describe_fit(arguments.spheres, json, breakdown, result);
  warn_of_thin_parts(arguments, mesh, result);
  warn_each(file, result_warnings(result));
  const std::string broken = broken_promises(result);
  if (!arguments.each) std::cout << describe(next_steps(arguments, result.certificate.covered));
  if (broken.empty()) return model.cad && !model.cad->proved ? kNo : kYes;
  tell(arguments.spheres + ": " + broken);
  return kNo;
}

// Where the spheres of each file go, in the order of the files. Throws Error for two of one name.
std::vector<std::string> outputs_of(const FitArguments& arguments) {
  const fs::path folder = arguments.spheres.empty() ? "." : arguments.spheres;
  std::map<std::string, std::string> taken;
  std::vector<std::string> outputs;
  for (const std::string& model : arguments.models) {
    const std::string output = (folder / fs::path(model).stem()).string() + ".json";
    const auto [other, is_new] = taken.emplace(output, model);
    if (!is_new)
      throw Error(model, "its spheres would go to " + output + ", as those of " + other->second);
    outputs.push_back(output);
  }
  return outputs;
}

// Whether there are spheres that are proved to cover, with whatever options they were made, by a
// search that was not interrupted.
bool has_cover(const std::string& file) {
  if (!fs::exists(file)) return false;
  try {
    const SphereFile found = load_spheres(file);
    return found.certificate && found.certificate->covered && !found.interrupted;
  } catch (const Error&) {
    return false;
  }
}

void require_one_file_options(const FitArguments& arguments) {
  const std::pair<const char*, const std::string&> kOptions[] = {
      {"--report", arguments.report}, {"--tree", arguments.tree}, {"--view", arguments.view}};
  for (const auto& [option, value] : kOptions) {
    if (!value.empty()) throw Error(option, "is of one file, not of each (--each)");
  }
}

// `fit --each`: runs `fit` on every file of this shard, with the name of its output filled in, and
// returns the largest exit code. A file that cannot be used is told and ends nothing.
int fit_each(FitArguments& arguments, const std::function<int(FitArguments&)>& fit) {
  require_one_file_options(arguments);
  const std::vector<std::string> models = arguments.models;
  const std::vector<std::string> outputs = outputs_of(arguments);
  if (!arguments.spheres.empty()) {
    std::error_code error;
    fs::create_directories(arguments.spheres, error);
    if (error) throw Error(arguments.spheres, "cannot be made: " + error.message());
  }
  int exit_code = kYes;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (!is_dealt_to(arguments.shard, i)) continue;
    if (arguments.skips_existing && has_cover(outputs[i])) {
      std::cout << one_line(outputs[i]) << ": is there\n";
      continue;
    }
    arguments.models = {models[i]};
    arguments.spheres = outputs[i];
    std::cout << one_line(models[i]) << ":\n";
    try {
      exit_code = std::max(exit_code, fit(arguments));
    } catch (const Error& error) {
      tell(error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

void add_fit(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("fit", "Cover a mesh with few spheres, with a proof");
  auto arguments = std::make_shared<FitArguments>();
  add_model_options(*command, *arguments);
  add_promise_options(*command, *arguments);
  add_method_options(*command, *arguments);
  add_output_options(*command, *arguments);
  command->footer(to_text(
      {.text = "Lengths are numbers, in output units (mesh units times --scale, or --units), or "
               "have a unit of their own: 1mm, 10cm, 0.5in. Smaller errors need more spheres, "
               "about three times as many for half of E. Of scenes (COLLADA, glTF, 3MF) at most "
               "2^25 vertices and triangles are read, and 2^18 nodes or objects; faces have at "
               "most four times as many corners as the mesh has vertices; other formats need about "
               "ten times their size of memory.",
       .exit_codes = "0 proved to cover and to protrude by at most E; 1 not proved (the files are "
                     "written and say so)",
       .examples = {
           "spherule fit part.stl -o part.json --max-error 1",
           "spherule fit part.stl -o part.json --units mm --max-error 1mm --min-external 1cm",
           "spherule fit part.stl -o part.json --max-error 2 --min-external 10 --view part.html",
           "spherule fit part.stl -o part.json --tool tool.json --levels 4,2,1 --tree part.tree",
           "spherule fit part.stl -o part.json --method paper --max-error 2 --report report.json",
           "spherule fit parts/*.stl --each -o covers --max-error 1 --skip-existing --shard "
           "2/8"}}));
  command->callback([arguments, &exit_code] {
    exit_code = arguments->each ? fit_each(*arguments, fit) : fit(*arguments);
  });
}

}  // namespace spherule
