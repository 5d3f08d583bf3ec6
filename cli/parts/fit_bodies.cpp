// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit_bodies.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/files/interruption.h"
#include "cli/files/model_bodies.h"
#include "cli/files/output.h"
#include "cli/files/result_warnings.h"
#include "cli/files/unit_warnings.h"
#include "cli/pages/view_page.h"
#include "cli/parts/fit_report.h"
#include "cli/text/exit_code.h"
#include "cli/text/message.h"
#include "cli/text/next_step.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "spheretree/build.h"
#include "spheretree/tree_file.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

namespace spherule {
namespace {

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
