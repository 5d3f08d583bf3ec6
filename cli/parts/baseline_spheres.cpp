// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/baseline_spheres.h"

#include "cli/files/files.h"
#include "cli/options/options.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "io/mesh_io.h"
#include "simplifier/baseline/made_conservative.h"
#include "simplifier/types/certificate.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

namespace spherule {
namespace {

constexpr const char* kSolid = "the mesh and its inside";

// What `make` returns, and how long it took.
template <typename Make>
auto timed(double& seconds, Make make) {
  const auto start = std::chrono::steady_clock::now();
  auto result = make();
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

// The spheres as they go to the file, and what is proved about these.
ConservativeSpheres certified(const TriangleMesh& mesh, std::vector<Sphere> spheres,
                              const SphereArguments& arguments, const Progress& progress) {
  if (arguments.conservative) {
    return made_conservative(mesh, spheres, arguments.padding, arguments.threads, progress);
  }
  // As `spherule audit` does, so that it comes to the same verdict.
  Certificate certificate =
      certify(mesh, spheres,
              {.padding = arguments.padding, .threads = arguments.threads, .progress = progress});
  return {std::move(spheres), 0.0, std::move(certificate)};
}

void print(const SphereArguments& arguments, Json figures, const ConservativeSpheres& result,
           const Json& seconds) {
  if (arguments.json) {
    figures["certificate"] = to_json(result.certificate);
    figures["seconds"] = seconds;
    std::cout << to_text(figures);
    return;
  }
  print_figures(figures);
  std::cout << describe(result.certificate, kSolid);
  print_figures({{"seconds", seconds}});
}

int run_method(const SphereBaseline& method, const SphereArguments& arguments) {
  check_outputs({arguments.output, arguments.tree_file}, {arguments.mesh});
  const ModelUnit unit = converted_unit(arguments);
  const double scale = unit.scale;
  const TriangleMesh mesh = read_mesh(arguments.mesh, {.scale = scale});
  double making = 0.0;
  double certifying = 0.0;
  MadeSpheres made;
  ConservativeSpheres result;
  {
    ProgressBar bar;
    bar.announce(method.text.name);
    made = timed(making, [&] { return method.run(mesh, arguments, bar.callback()); });
    result = timed(certifying, [&] {
      return certified(mesh, std::move(made.spheres), arguments, bar.callback());
    });
  }
  std::optional<SphereTree> tree;
  if (!arguments.tree_file.empty()) tree = made.tree(result.spheres);

  SphereFile file = {result.spheres, record(result.certificate), std::move(made.options)};
  file.options["baseline"] = std::string(method.text.name);
  file.options["scale"] = scale;
  if (const std::string units = symbol_of(unit); !units.empty()) file.options["units"] = units;
  file.options["padding"] = arguments.padding;
  Json figures = {{"method", method.text.name}, {"sphere_count", result.spheres.size()}};
  figures.update(made.figures);
  if (arguments.conservative) {
    file.options["conservative"] = true;
    file.options["growth"] = result.inflation;
    figures["growth"] = to_json(result.inflation);
  }
  write_uninterrupted([&] {
    save_spheres(file, arguments.output);
    if (tree) save_tree(*tree, arguments.tree_file);
  });
  print(arguments, figures, result, {{"method", making}, {"certify", certifying}});
  if (result.certificate.covered) return kYes;
  tell(arguments.output + ": the spheres are not proved to cover" +
       (arguments.conservative ? "" : "; --conservative inflates them"));
  return kNo;
}

}  // namespace

std::vector<std::string> add_sphere_baselines(CLI::App& baseline, int& exit_code) {
  std::vector<std::string> examples;
  for (const SphereBaseline& method : sphere_baselines()) {
    auto arguments = std::make_shared<SphereArguments>();
    CLI::App* command = add_baseline_method(
        baseline, method.text, *arguments, "Where the spheres go (JSON), covering or not",
        {.text = "Lengths are in output units.",
         .exit_codes = "0 the spheres are proved to cover the mesh and its inside, as `spherule "
                       "audit` proves it; 1 they are not"});
    method.add_options(*command, *arguments);
    arguments->lengths.add(*command, "--padding", arguments->padding,
                           "The mesh grown by this much is to be covered (default: 0)");
    command->add_flag("--conservative", arguments->conservative,
                      "Grow every sphere by the proved uncovered depth, so that they cover");
    add_threads_option(*command, arguments->threads);
    examples.emplace_back(method.text.example);
    command->callback(
        [&method, arguments, &exit_code] { exit_code = run_method(method, *arguments); });
  }
  return examples;
}

}  // namespace spherule
