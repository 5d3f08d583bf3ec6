// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/files.h"
#include "cli/files/mesh_output.h"
#include "cli/options/options.h"
#include "cli/parts/baseline.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "simplifier/baseline/convex_decomposition.h"
#include "simplifier/baseline/convex_hull.h"
#include "simplifier/baseline/decimation.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

namespace spherule {
namespace {

struct MeshArguments : BaselineArguments {
  DecimationOptions decimation;
  ConvexHullOptions hull;
  ConvexDecompositionOptions decomposition;
};

// What a method makes, and what it is called in the figures.
struct BaselineMeshes {
  std::vector<TriangleMesh> meshes;
  Json figures = Json::object();
};

// A method is one row of methods() below: its name, a sentence, what only it takes, and the call.
struct Method {
  BaselineText text;
  void (*add_options)(CLI::App&, MeshArguments&);
  BaselineMeshes (*run)(const TriangleMesh&, const MeshArguments&);
};

void add_decimation(CLI::App& command, MeshArguments& arguments) {
  DecimationOptions& options = arguments.decimation;
  auto* triangles = command.add_option("--triangles", options.target_triangles,
                                       "How many triangles are wanted (default: few)");
  triangles->check(check_positive);
  auto* error = arguments.lengths.add(command, "--max-error", options.max_error,
                                      "Largest error as the library estimates it: no bound");
  // Without either, hardly anything would be left.
  auto* limits = command.add_option_group("limits");
  limits->add_options(triangles, error);
  limits->require_option(1, 2);
}

BaselineMeshes run_decimation(const TriangleMesh& mesh, const MeshArguments& arguments) {
  const Decimation result = decimate(mesh, arguments.decimation);
  return {{result.mesh},
          {{"conservative", false},
           {"estimated_error", to_json(result.estimated_error)},
           {"loss", to_json(result.deviation.loss)},
           {"excess", to_json(result.deviation.excess)}}};
}

void add_hull(CLI::App& command, MeshArguments& arguments) {
  arguments.lengths.add(command, "--padding", arguments.hull.padding,
                        "Hold spheres of this radius about every vertex");
}

BaselineMeshes run_hull(const TriangleMesh& mesh, const MeshArguments& arguments) {
  const ConvexHull hull = convex_hull(mesh, arguments.hull);
  const MeshDeviation deviation = measure_deviation(mesh, hull.mesh);
  return {{hull.mesh},
          {{"conservative", true},
           {"expansion", to_json(hull.expansion)},
           {"loss", to_json(deviation.loss)},
           {"excess", to_json(deviation.excess)}}};
}

void add_decomposition(CLI::App& command, MeshArguments& arguments) {
  ConvexDecompositionOptions& options = arguments.decomposition;
  arguments.lengths.add(command, "--concavity", options.max_concavity,
                        "Concavity at which parts stay apart (default: 1 % of the box diagonal)");
  command.add_option("--parts", options.min_parts, "No fewer parts than this")
      ->check(check_positive);
}

BaselineMeshes run_decomposition(const TriangleMesh& mesh, const MeshArguments& arguments) {
  const ConvexDecomposition result = decompose(mesh, arguments.decomposition);
  return {result.parts,
          {{"conservative", false},
           {"parts", result.parts.size()},
           {"loss", to_json(result.deviation.loss)},
           {"excess", to_json(result.deviation.excess)}}};
}

const std::vector<Method>& methods() {
  static const std::vector<Method> kMethods = {
      {{"decimate", "Fewer triangles by quadric error (meshoptimizer); not conservative",
        "spherule baseline decimate part.stl -o half.stl --triangles 500"},
       add_decimation,
       run_decimation},
      {{"hull", "Convex hull (qhull); conservative as OBJ and PLY, STL rounds",
        "spherule baseline hull part.stl -o hull.obj"},
       add_hull,
       run_hull},
      {{"decompose", "Approximate convex decomposition (HACD); not conservative",
        "spherule baseline decompose part.stl -o parts.obj --concavity 2"},
       add_decomposition,
       run_decomposition}};
  return kMethods;
}

Json count(const TriangleMesh& mesh) {
  return {{"triangles", mesh.triangles.size()}, {"vertices", mesh.vertices.size()}};
}

double volume_of(const TriangleMesh& mesh) {
  return mesh_report(mesh, {.self_intersections = false}).volume;
}

int run_method(const Method& method, const MeshArguments& arguments) {
  if (!std::filesystem::is_directory(arguments.output)) {
    check_outputs({arguments.output}, {arguments.mesh});
  }
  check_mesh_output(arguments.output);
  ProgressBar bar;
  bar.announce(method.text.name);
  const TriangleMesh mesh = read_mesh(arguments.mesh, {.scale = converted_unit(arguments).scale});
  const BaselineMeshes result = method.run(mesh, arguments);
  bar.clear();
  write_uninterrupted([&] { write_meshes(result.meshes, arguments.output); });

  double volume = 0.0;
  for (const TriangleMesh& part : result.meshes) volume += volume_of(part);
  const MeshReport report = mesh_report(mesh, {.self_intersections = false});
  Json figures = {{"method", method.text.name},
                  {"before", count(mesh)},
                  {"after", count(join_parts(result.meshes))}};
  figures["volume_ratio"] =
      report.closed && report.volume != 0.0 ? to_json(volume / report.volume) : Json(nullptr);
  figures.update(result.figures);
  if (rounds_coordinates(arguments.output)) figures["conservative"] = false;
  if (arguments.json) {
    std::cout << to_text(figures);
  } else {
    print_figures(figures);
  }
  return kYes;
}

}  // namespace

std::vector<std::string> add_mesh_baselines(CLI::App& baseline, int& exit_code) {
  std::vector<std::string> examples;
  for (const Method& method : methods()) {
    auto arguments = std::make_shared<MeshArguments>();
    CLI::App* command = add_baseline_method(
        baseline, method.text, *arguments,
        "Where the result goes: STL, OBJ or PLY, or a folder for a file a part",
        {.text = "Figures: `loss` is how far the surface of the mesh gets from the result, "
                 "`excess` how far the result sticks out: lower and upper bound, measured.",
         .exit_codes = "0 done"});
    method.add_options(*command, *arguments);
    examples.emplace_back(method.text.example);
    command->callback(
        [&method, arguments, &exit_code] { exit_code = run_method(method, *arguments); });
  }
  return examples;
}

}  // namespace spherule
