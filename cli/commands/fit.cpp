// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/view_page.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "io/sphere_file.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/simplify.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

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

// Of the box diagonal: how far apart rounding leaves what was one vertex.
constexpr double kCrack = 1e-6;

void write_view(const FitArguments& arguments, const TriangleMesh& mesh,
                const Simplification& result, const std::optional<SphereTree>& tree) {
  ViewScene scene{.title = arguments.models.front(), .items = {}};
  scene.items.push_back({.name = arguments.models.front(), .parts = {{mesh}}});
  scene.items.push_back({.name = "external spheres",
                         .parts = {{result.external.spheres}},
                         .external = true,
                         .shown = false});
  const ViewContent spheres = tree ? ViewContent(*tree) : ViewContent(result.cover.spheres);
  scene.items.push_back({.name = arguments.spheres, .parts = {{spheres}}});
  write_file_atomically(arguments.view, make_view_page(scene));
}

// Thin walls need many spheres: there the count goes with the area, however thin they are.
void warn_of_thin_parts(const FitArguments& arguments, const TriangleMesh& mesh,
                        const Simplification& result) {
  const std::size_t count = result.cover.spheres.size();
  if (count <= mesh.triangles.size()) return;
  const double max_error = result.options.max_error;
  const std::size_t thin = spheres_in_thin_parts(result.external, result.cover.spheres, max_error);
  if (2 * thin <= count) return;
  std::ostringstream text;
  text << arguments.models.front() << ": " << thin << " of " << count
       << " spheres stand where the part is thinner than 2 E, and the mesh has only "
       << mesh.triangles.size()
       << " triangles: thin parts need many spheres. Far fewer would do with --max-error "
       << 2.0 * max_error;
  warn(text.str());
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
    if (reading.scale != 1.0) repeat("--units", arguments.unit.units, view);
    repeat("-o", beside(arguments.spheres, ".html"), view);
    steps.push_back({std::move(view), "examine them"});
  }
  if (arguments.tree.empty()) {
    steps.push_back({{"tree", arguments.spheres, "-o", beside(arguments.spheres, ".tree")},
                     "for collision checks"});
  }
  return steps;
}

std::string describe_lower_bound(const Simplification& result) {
  const std::size_t bound = result.cover.lower_bound;
  if (!result.options.lower_bound) return {};
  if (bound == 0) return "lower bound: not known (see spherule fit --help)\n";
  return "lower bound: no cover at this error has fewer than " + std::to_string(bound) +
         " spheres\n";
}

void print_reading(const std::string& file, const ModelFile& model, const ModelReadOptions& options,
                   ModelUnit& unit, const MeshReport& report) {
  if (model.cad) {
    note_cad_unit(model.cad->stated_unit, unit);
    std::cout << describe(*model.cad);
  }
  std::cout << describe(unit) << describe(report) << std::endl;
  if (report.boundary_edges == 0 || model.cad || options.weld > 0.0) return;
  std::ostringstream text;
  text << "if rounding has left cracks in " << file << ", --weld "
       << kCrack * report.box.diagonal().norm() << " shuts them";
  tell(text.str());
}

void write_trees(const FitArguments& arguments, const TriangleMesh& mesh,
                 const Simplification& result) {
  std::optional<SphereTree> tree;
  if (!arguments.tree.empty() || !arguments.view.empty()) tree = sphere_tree(result);
  if (!arguments.tree.empty()) save_tree(*tree, arguments.tree);
  if (!arguments.view.empty()) write_view(arguments, mesh, result, tree);
}

void print_result(const std::string& file, const Simplification& result,
                  const std::optional<CoverBreakdown>& breakdown, bool is_cad) {
  std::cout << "options: max error " << result.options.max_error << ", min external diameter "
            << result.options.min_external_diameter << ", padding " << result.external.padding
            << (is_cad ? " (chord error and rounding" : " (rounding") << " of the file included)\n"
            << "external spheres: " << result.external.spheres.size();
  if (result.options.external == ExternalPlacement::kReachable) {
    std::cout << ", ways into the part that are wider than " << result.options.min_external_diameter
              << " by " << result.external.closing_slack << " stay open (proved)";
  }
  std::cout << "\n";
  if (result.options.keep_concave_edges) {
    std::cout << "zones along sharp concave edges: " << result.external.concave_edges.size()
              << "\n";
  }
  std::cout << one_line(file) << ": " << result.cover.spheres.size() << " spheres\n"
            << (result.interrupted ? std::string(kInterruptedSearch) + "\n" : "")
            << describe(result.certificate, "the simplified solid") << describe(result.levels)
            << (breakdown ? describe(*breakdown) : "") << describe_lower_bound(result)
            << "seconds: external " << result.times.external << ", cover " << result.times.cover
            << ", levels " << result.times.levels << ", certify " << result.times.certify << "\n";
}

// Fails (kNo) if a promise about the spheres is not proved; the files are written nevertheless and
// say so.
int fit(FitArguments& arguments) {
  if (arguments.spheres.empty()) {
    arguments.spheres = default_output(arguments.models.front(), ".json", FileKind::kSpheres);
  }
  if (arguments.models.size() > 1 || arguments.bodies) return fit_bodies(arguments);
  check_outputs({arguments.spheres, arguments.report, arguments.tree, arguments.view},
                {arguments.models.front(), arguments.tool, arguments.zones});
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
  std::optional<CoverBreakdown> breakdown;
  if (!arguments.report.empty()) {
    breakdown = cover_breakdown(mesh, result.external, result.cover.spheres,
                                result.options.max_error, options.threads);
  }

  write_uninterrupted([&] {
    if (breakdown) {
      write_file_atomically(arguments.report,
                            fit_report({file, mesh, model.cad, unit.scale, report}, unit, result,
                                       *breakdown, arguments.report_content));
    }
    write_trees(arguments, mesh, result);
  });

  print_result(arguments.spheres, result, breakdown, model.cad.has_value());
  warn_of_thin_parts(arguments, mesh, result);
  warn_each(file, result_warnings(result));
  const std::string broken = broken_promises(result);
  if (!arguments.each) std::cout << describe(next_steps(arguments, result.certificate.covered));
  if (broken.empty()) return model.cad && !model.cad->proved ? kNo : kYes;
  tell(arguments.spheres + ": " + broken);
  return kNo;
}

}  // namespace

void add_fit(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("fit", "Cover a mesh with few spheres, with a proof");
  auto arguments = std::make_shared<FitArguments>();
  add_fit_options(*command, *arguments);
  command->footer(to_text(
      {.text =
           "Lengths are numbers, in output units (mesh units times --scale, or --units), or have "
           "a unit of their own: 1mm, 10cm, 0.5in. Smaller errors need more spheres, about three "
           "times as many for half of E. Of scenes (COLLADA, glTF, 3MF) at most 2^25 vertices and "
           "triangles are read, and 2^18 nodes or objects; faces have at most four times as many "
           "corners as "
           "the mesh has vertices; other formats need about ten times their size of memory.",
       .exit_codes = "0 proved to cover and to protrude by at most E; 1 not proved (the files are "
                     "written and say so)",
       .examples = {
           "spherule fit part.stl -o part.json --max-error 1",
           "spherule fit part.stl -o part.json --units mm --max-error 1mm --min-external 1cm",
           "spherule fit part.stl -o part.json --max-error 2 --min-external 10 --view "
           "part.html",
           "spherule fit part.stl -o part.json --tool tool.json --levels 4,2,1 --tree "
           "part.tree",
           "spherule fit part.stl -o part.json --method paper --max-error 2 --report "
           "report.json",
           "spherule fit parts/*.stl --each -o covers --max-error 1 --skip-existing --shard "
           "2/8"}}));
  command->callback([arguments, &exit_code] {
    exit_code = arguments->each ? fit_each(*arguments, fit) : fit(*arguments);
  });
}

}  // namespace spherule
