// SPDX-License-Identifier: BSD-3-Clause
// spherule_closing [STEPS [MODEL SPHERES.json DIAMETER]...]: how far spheres protrude from the
// model closed at a diameter, judged by what shares no code with stage 1 (protrusion_judge.h), with
// grids of so many steps a diameter. Of models and spheres as named (the scale is the file's);
// without any, of those of SPHERULE_MODELS, whose spheres are fitted here, at D and at D + slack.
#include "base/error.h"
#include "bench/closing/protrusion_judge.h"
#include "geometry/sphere.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "simplifier/simplify.h"
#include "tests/support/program.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <variant>

namespace spherule {
namespace {

using closing::JudgedProtrusion;
using closing::JudgeOptions;

struct Model {
  const char* file;
  double scale;
  double max_error;  // as a share of the box diagonal; 0: 20, as of the robot's links
};
constexpr const char* kLinks = "robots/abb_irb4400l/meshes/irb4400l_30_243/visual";
constexpr Model kParts[] = {
    {"parts/1002_tray_bottom.STL", 1.0, 0.02}, {"parts/base_so101_v2.stl", 1.0, 0.02},
    {"parts/bent_sheet_1mm.stl", 1.0, 0.02},   {"parts/cycloidal.ply", 1.0, 0.02},
    {"parts/featuretype.STL", 1.0, 0.02},      {"parts/halfopen_box_small.stl", 1.0, 0.02},
    {"parts/idler_riser.STL", 1.0, 0.02},      {"parts/pipe_id40.stl", 1.0, 0.02},
    {"parts/plate_holes.STL", 1.0, 0.02},      {"parts/puzzle_bent.dae", 1.0, 0.02},
    {"parts/puzzle_mount.stl", 1.0, 0.02},     {"parts/sealed_housing_with_core.stl", 1.0, 0.02},
    {"parts/spur_gear_m2_z24.stl", 1.0, 0.02}, {"parts/three_pipes.stl", 1.0, 0.02},
    {"parts/weld_workobject_1.stl", 1.0, 0.02}};
constexpr const char* kLinkNames[] = {"base_link", "link_1", "link_2", "link_3",
                                      "link_4",    "link_5", "link_6"};

void print_judged(const TriangleMesh& mesh, std::span<const Sphere> spheres, double diameter,
                  const JudgeOptions& options) {
  const JudgedProtrusion judged =
      closing::judge_protrusion_from_closing(mesh, spheres, diameter, options);
  std::printf("  closed at %.6g: %.4g to %.4g (grid %.3g) at (%.6g %.6g %.6g), (%.6g %.6g %.6g)\n",
              diameter, judged.lower, judged.upper, judged.step, judged.lower_at.x(),
              judged.lower_at.y(), judged.lower_at.z(), judged.upper_at.x(), judged.upper_at.y(),
              judged.upper_at.z());
  std::fflush(stdout);
}

JudgeOptions options_for(double diameter, int steps, double max_error) {
  JudgeOptions options;
  options.step = diameter / steps;
  options.tolerance = 0.02 * max_error;
  return options;
}

void fit_and_judge(const std::string& name, const TriangleMesh& mesh,
                   const SimplifyOptions& options, int steps) {
  const Simplification fit = simplify(mesh, options);
  const double d = fit.options.min_external_diameter;
  std::printf(
      "%s: E %.6g, D %.6g, slack %.2f %% of D, %zu spheres, seconds: stage 1 %.2f, in all "
      "%.2f\n",
      name.c_str(), fit.options.max_error, d, 100.0 * fit.external.closing_slack / d,
      fit.cover.spheres.size(), fit.times.external,
      fit.times.external + fit.times.cover + fit.times.certify);
  for (const double diameter : {d, d + fit.external.closing_slack}) {
    print_judged(mesh, fit.cover.spheres, diameter,
                 options_for(diameter, steps, fit.options.max_error));
  }
}

void judge_models(const std::filesystem::path& models, int steps) {
  SimplifyOptions options;
  options.effort = 0;
  for (const Model& part : kParts) {
    const TriangleMesh mesh = read_mesh(models / part.file, {.scale = part.scale});
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
    options.max_error = part.max_error * box.diagonal().norm();
    options.min_external_diameter = 4.0 * options.max_error;
    fit_and_judge(part.file, mesh, options, steps);
  }
  for (const char* link : kLinkNames) {
    options.max_error = 20.0;
    options.min_external_diameter = 100.0;
    const auto file = models / kLinks / (std::string(link) + ".stl");
    fit_and_judge(link, read_mesh(file, {.scale = 1000.0}), options, steps);
  }
}

double number(const SphereFile& file, const std::string& option, double otherwise) {
  const auto found = file.options.find(option);
  if (found == file.options.end()) return otherwise;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  const auto* value = std::get_if<double>(&found->second);
  return value != nullptr ? *value : otherwise;
}

void judge_files(const char* model, const char* spheres, double diameter, int steps) {
  const SphereFile file = load_spheres(spheres);
  const TriangleMesh mesh = read_mesh(model, {.scale = number(file, "scale", 1.0)});
  std::printf("%s: %zu spheres\n", spheres, file.spheres.size());
  print_judged(mesh, file.spheres, diameter,
               options_for(diameter, steps, number(file, "max-error", 0.0)));
}

int run(int argc, char** argv) {
  if ((argc - 2) % 3 > 0) throw Error("usage", "[STEPS [MODEL SPHERES.json DIAMETER]...]");
  const int steps = argc > 1 ? static_cast<int>(count_argument("STEPS", argv[1], 4)) : 32;
  if (argc <= 2) judge_models(needed_models_folder(), steps);
  for (int i = 2; i + 2 < argc; i += 3) {
    const double diameter = number_argument("DIAMETER", argv[i + 2], 0.0, kMaxCoordinate);
    judge_files(argv[i], argv[i + 1], diameter, steps);
  }
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  return spherule::run_program("spherule_closing", [&] { return spherule::run(argc, argv); });
}
