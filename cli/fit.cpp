// SPDX-License-Identifier: BSD-3-Clause
#include "cli/check_length.h"
#include "cli/command.h"
#include "cli/fit_report.h"
#include "cli/help.h"
#include "cli/interruption.h"
#include "cli/model_file.h"
#include "cli/next_step.h"
#include "cli/outline.h"
#include "cli/output.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/report_content.h"
#include "cli/second_phase.h"
#include "cli/unit_warnings.h"
#include "cli/view_page.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/simplify.h"
#include "simplifier/zones.h"
#include "spheretree/atomic_file.h"
#include "spheretree/error.h"
#include "spheretree/sphere_file.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Of the box diagonal: how far apart rounding leaves what was one vertex.
constexpr double kCrack = 1e-6;

struct FitArguments {
  std::string mesh;
  std::string spheres;
  std::string report;
  std::string tree;
  std::string view;
  std::string tool;
  std::string zones;
  std::string levels;
  ReportContent report_content = ReportContent::kNoExternalSpheres;
  std::string method = fit_method_names().front();
  std::string external = placement_names().front();
  ModelReadOptions reading;
  SimplifyOptions options;
};

void write_view(const FitArguments& arguments, const TriangleMesh& mesh,
                const Simplification& result, const std::optional<SphereTree>& tree) {
  ViewScene scene{.title = arguments.mesh, .items = {}};
  scene.items.push_back({.name = arguments.mesh, .parts = {{mesh}}});
  scene.items.push_back({.name = "external spheres",
                         .parts = {{result.external.balls}},
                         .external = true,
                         .shown = false});
  const ViewContent spheres = tree ? ViewContent(*tree) : ViewContent(result.cover.spheres);
  scene.items.push_back({.name = arguments.spheres, .parts = {{spheres}}});
  write_file_atomically(arguments.view, make_view_page(scene));
}

// Runs what depends on a file that an option names, and blames that file for what is wrong with
// `subject`.
template <typename Use>
auto blaming_file(const std::string& file, std::string_view subject, Use use) {
  try {
    return use();
  } catch (const Error& error) {
    if (file.empty() || !error.subject().starts_with(subject)) throw;
    throw Error(file, error.what());
  }
}

void warn(const std::string& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::cerr << "spherule: warning: " << file << ": " << warning << "\n";
  }
}

// Spheres suit thin walls badly: there the count goes with the area, however thin they are.
void warn_of_thin_parts(const FitArguments& arguments, const TriangleMesh& mesh,
                        const Simplification& result) {
  const std::size_t count = result.cover.spheres.size();
  if (count <= mesh.triangles.size()) return;
  const double max_error = result.options.max_error;
  const std::size_t thin = spheres_in_thin_parts(result.external, result.cover.spheres, max_error);
  if (2 * thin <= count) return;
  std::cerr << "spherule: warning: " << arguments.mesh << ": " << thin << " of " << count
            << " spheres stand where the part is thinner than 2 E, and the mesh has only "
            << mesh.triangles.size()
            << " triangles: spheres suit thin parts badly. Far fewer would do with --max-error "
            << 2.0 * max_error << "\n";
}

std::vector<NextStep> next_steps(const FitArguments& arguments, bool is_covered) {
  std::vector<NextStep> steps;
  if (!is_covered) {
    steps.push_back({{"audit", arguments.mesh, arguments.spheres, "--repair",
                      beside(arguments.spheres, ".mended.json")},
                     "make them cover"});
  }
  // `view` reads the mesh as it is: the page would hold it in another unit, or other triangles.
  const ModelReadOptions& reading = arguments.reading;
  const bool is_read_plainly =
      reading.scale == 1.0 && reading.chord_error == 0.0 && reading.weld == 0.0;
  if (arguments.view.empty() && is_read_plainly) {
    steps.push_back(
        {{"view", arguments.mesh, arguments.spheres, "-o", beside(arguments.spheres, ".html")},
         "look at them"});
  }
  if (arguments.tree.empty()) {
    steps.push_back({{"tree", arguments.spheres, "-o", beside(arguments.spheres, ".tree")},
                     "for collision checks"});
  }
  return steps;
}

std::string describe_lower_bound(const SphereCover& cover) {
  if (cover.lower_bound == 0) return {};
  return "lower bound: no cover at this error has fewer than " + std::to_string(cover.lower_bound) +
         " spheres\n";
}

// Fails (kNo) if a promise about the spheres is not proved; the files are written nevertheless and
// say so.
int fit(const FitArguments& arguments) {
  check_outputs({arguments.spheres, arguments.report, arguments.tree, arguments.view},
                {arguments.mesh, arguments.tool, arguments.zones});
  SimplifyOptions options = arguments.options;
  choose_method(arguments.method, options);
  options.external = placement_named(arguments.external);
  if (!arguments.levels.empty()) options.levels = levels_named(arguments.levels);
  options.history = !arguments.report.empty();
  if (!arguments.zones.empty()) options.zones = read_zones(arguments.zones);
  if (!arguments.tool.empty()) {
    const SphereFile tool = load_spheres(arguments.tool);
    options.min_external_diameter =
        blaming_file(arguments.tool, "tool", [&] { return tool_diameter(tool.spheres); });
  }

  ProgressBar reading;
  reading.announce("reading");
  const ModelFile model = read_model(arguments.mesh, arguments.reading);
  const TriangleMesh& mesh = model.mesh;
  const MeshReport report = mesh_report(mesh);
  reading.clear();
  if (model.cad) std::cout << describe(*model.cad);
  std::cout << describe(report) << std::endl;
  if (report.boundary_edges > 0 && !model.cad && arguments.reading.weld == 0.0) {
    std::cerr << "spherule: if rounding has left cracks in " << arguments.mesh << ", --weld "
              << kCrack * report.box.diagonal().norm() << " shuts them\n";
  }

  warn(arguments.mesh, length_warnings(report, options));
  StopOnInterruption interruption;
  options.on_proved = [&](std::size_t) { interruption.have_answer(); };
  options.stop = interruption.token();
  const Simplification result = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    return blaming_file(arguments.zones, "zone ", [&] { return simplify(mesh, options); });
  }();

  // First of all what was asked for and is proved.
  write_uninterrupted([&] {
    SphereFile file = sphere_file(result, arguments.reading.scale);
    store_reading(arguments.reading, model, file);
    save_spheres(file, arguments.spheres);
  });
  std::optional<CoverBreakdown> breakdown;
  if (!arguments.report.empty()) {
    breakdown = cover_breakdown(mesh, result.external, result.cover.spheres,
                                result.options.max_error, options.threads);
  }

  write_uninterrupted([&] {
    if (breakdown) {
      write_file_atomically(arguments.report,
                            fit_report(arguments.mesh, model, report, result, *breakdown,
                                       arguments.reading.scale, arguments.report_content));
    }
    std::optional<SphereTree> tree;
    if (!arguments.tree.empty() || !arguments.view.empty()) tree = sphere_tree(result);
    if (!arguments.tree.empty()) save_tree(*tree, arguments.tree);
    if (!arguments.view.empty()) write_view(arguments, mesh, result, tree);
  });

  std::cout << "options: max error " << result.options.max_error << ", min external diameter "
            << result.options.min_external_diameter << ", padding " << result.external.padding
            << (model.cad ? " (chord error and rounding" : " (rounding")
            << " of the file included)\n"
            << "external spheres: " << result.external.balls.size();
  if (result.options.external == ExternalPlacement::kReachable) {
    std::cout << ", ways into the part that are wider than " << result.options.min_external_diameter
              << " by " << result.external.closing_slack << " stay open (proved)";
  }
  std::cout << "\n";
  if (options.keep_concave_edges) {
    std::cout << "zones along sharp concave edges: " << result.external.concave_edges.size()
              << "\n";
  }
  std::cout << "spheres: " << result.cover.spheres.size() << "\n"
            << describe(result.certificate, "the simplified solid") << describe(result.levels)
            << (breakdown ? describe(*breakdown) : "") << describe_lower_bound(result.cover)
            << "seconds: external " << result.times.external << ", cover " << result.times.cover
            << ", levels " << result.times.levels << ", certify " << result.times.certify << "\n";
  warn_of_thin_parts(arguments, mesh, result);
  warn(arguments.mesh, volume_warnings(result));
  const std::string broken = broken_promises(result);
  std::cout << describe(next_steps(arguments, result.certificate.covered));
  if (broken.empty()) return model.cad && !model.cad->proved ? kNo : kYes;
  std::cerr << "spherule: " << arguments.spheres << ": " << broken << "\n";
  return kNo;
}

}  // namespace

void add_fit(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("fit", "Cover a mesh with few spheres, with a proof");
  auto arguments = std::make_shared<FitArguments>();
  SimplifyOptions& options = arguments->options;
  command
      ->add_option("mesh", arguments->mesh, "STL, OBJ, PLY, OFF, DAE, 3MF, glTF, GLB; STEP or IGES")
      ->required()
      ->type_name(kFile);
  command->add_option("-o,--output", arguments->spheres, "Where the spheres go (JSON)")
      ->required()
      ->type_name(kFile);
  command->add_option("--scale", arguments->reading.scale,
                      "Output units per mesh unit (of STEP and IGES: per millimetre)");
  command
      ->add_option(
          "--weld", arguments->reading.weld,
          "Join vertices that are no further apart, so that cracks which rounding has left "
          "do not open the mesh; added to the padding")
      ->check(check_length);
  command
      ->add_option(
          "--chord-error", arguments->reading.chord_error,
          "STEP and IGES: how far the part may be from its triangles; what is proved of it "
          "is added to the padding (default: a two-thousandth of the box diagonal)")
      ->check(check_length);
  auto* diameter = command->add_option(
      "--min-external", options.min_external_diameter,
      "D, diameter of the smallest thing that will meet the model (default: 4 E). With E / 2 "
      "or less only gaps narrower than that are filled: the method without stage 1");
  diameter->check(check_length);
  command
      ->add_option("--tool", arguments->tool,
                   "D from the tool that will meet the model: the smallest of these spheres (JSON)")
      ->type_name(kFile)
      ->excludes(diameter);
  command
      ->add_option("--tightness", options.tightness,
                   "How much wider than D a way in may be and still be filled, as a share of D "
                   "(default: 0.03); less takes longer")
      ->check(CLI::Range(0.001, ExternalOptions::kNoTightness));
  command
      ->add_option("--zones", arguments->zones,
                   "Where E and D are smaller: balls, boxes and capsules (JSON)")
      ->type_name(kFile);
  command->add_flag("--keep-concave-edges", options.keep_concave_edges,
                    "A smaller D along sharp concave edges, so that they are not filled");
  command
      ->add_option("--max-error", options.max_error,
                   "E, how far the spheres may protrude (default: 1 % of the box diagonal)")
      ->check(check_length);
  command->add_option("--padding", options.padding, "Grow the mesh by this much")
      ->check(check_length);
  command->add_option("--min-radius", options.min_radius, "No sphere is smaller than this")
      ->check(check_length);
  command
      ->add_option("--method", arguments->method,
                   "How the inside is covered: cover (fewest spheres), paper (the paper's loop), "
                   "medial (AMAA) or packing (largest first)")
      ->check(CLI::IsMember(fit_method_names()));
  command
      ->add_option("--external", arguments->external,
                   "How external spheres are placed: reachable, random, none")
      ->check(CLI::IsMember(placement_names()));
  command
      ->add_option("--external-limit", options.external_limit, "Attempts of the random placement")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--min-internal", options.min_internal_diameter,
                   "Diameter at which paper and packing seed a sphere (default: E / 2)")
      ->check(check_length);
  command
      ->add_option("--levels", arguments->levels,
                   "Fit coarser levels of detail too and join all in one tree; the "
                   "finest is E")
      ->type_name("E1,E2,...");
  // Without the check CLI11 takes -1 for the largest number; files store 63 bits.
  command->add_option("--seed", options.seed, "Seed of everything random")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  auto* effort =
      command->add_option("--effort", options.effort,
                          "Rounds of looking for fewer spheres than at first, with cover; 0: none");
  effort->check(CLI::NonNegativeNumber);
  command
      ->add_option_function<double>(
          "--seconds",
          [arguments](double seconds) {
            arguments->options.seconds = seconds;
            arguments->options.effort = std::numeric_limits<int>::max();
          },
          "With cover: look for fewer spheres for so long, less where it no longer finds any; the "
          "result then depends on the machine")
      ->check(CLI::PositiveNumber)
      ->check(check_length)
      ->excludes(effort);
  command->add_option("--threads", options.threads, "Threads, 0: all; the result is the same")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--report", arguments->report,
                   "Where the report goes (JSON): the mesh, where the spheres go, history, times")
      ->type_name(kFile);
  add_external_spheres_flag(*command, arguments->report_content);
  command->add_flag("--lower-bound", options.lower_bound,
                    "Prove, too, how few spheres any cover must have (with cover); takes several "
                    "times as long as the first answer");
  command->add_option("--tree", arguments->tree, "Where the sphere tree goes")->type_name(kFile);
  command->add_option("--view", arguments->view, "Where a page to look at goes (HTML)")
      ->type_name(kFile);
  command->footer(to_text(
      {.text = "Lengths are in output units: mesh units times --scale. Smaller errors need more "
               "spheres, about three times as many for half of E.",
       .exit_codes = "0 proved to cover and to protrude by at most E; 1 not proved (the files are "
                     "written and say so)",
       .examples = {"spherule fit part.stl -o part.json --max-error 1",
                    "spherule fit part.stl -o part.json --max-error 2 --min-external 10 --view "
                    "part.html",
                    "spherule fit part.stl -o part.json --tool tool.json --levels 4,2,1 --tree "
                    "part.tree",
                    "spherule fit part.stl -o part.json --method packing --max-error 2 --report "
                    "report.json"}}));
  command->callback([arguments, &exit_code] { exit_code = fit(*arguments); });
}

}  // namespace spherule
