// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/internal/stages.h"
#include "simplifier/option_record.h"
#include "simplifier/types/simplification.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <optional>
#include <ostream>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

constexpr double kResolutionOfError = 0.005;

void check_stage2_method(const SimplifyOptions& options) {
  if (!options.stage2_method) return;
  const std::string& name = options.stage2_method->name;
  const std::vector<std::string> taken = method_names();
  if (name.empty() || std::find(taken.begin(), taken.end(), name) != taken.end()) {
    throw Error("method", "a stage 2 method from outside needs a name of its own");
  }
  if (!options.stage2_method->run) {
    throw Error("method", "there is no stage 2 method '" + name + "' here");
  }
}

// What the stages would refuse under other names, and what option_record() could not store.
void check_simplify_options(const SimplifyOptions& options) {
  const auto check = [](const char* name, double value) {
    if (!(value >= 0.0 && value <= kMaxCoordinate)) {
      throw Error(name, "must be finite and not negative");
    }
  };
  check("max error", options.max_error);
  check("min external diameter", options.min_external_diameter);
  check("padding", options.padding);
  check("min radius", options.min_radius);
  check("min internal diameter", options.min_internal_diameter);
  check("seconds", options.seconds);
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (options.seed > kLargest) throw Error("seed", "must be below 2^63");
}

// Fills in E and the levels, the coarsest first and E last, where levels are requested.
void complete_levels(SimplifyOptions& options) {
  if (options.levels.empty()) return;
  options.levels = check_levels(options.levels);
  if (options.max_error == 0.0) options.max_error = options.levels.front();
  if (options.levels.front() < options.max_error) {
    throw Error("levels", "must not be finer than the max error");
  }
  if (options.levels.front() > options.max_error) {
    options.levels.insert(options.levels.begin(), options.max_error);
    options.levels = check_levels(options.levels);
  }
  std::reverse(options.levels.begin(), options.levels.end());
}

// Before the long work: spheres protrude by about as much, and their certificate would refuse them.
void check_size(const SimplifyOptions& options, const MeshDistance& distance) {
  constexpr double kLargest = 0x1p24;  // of the largest coordinate
  const double largest = internal::largest_coordinate(distance.box());
  const double error = options.levels.empty() ? options.max_error : options.levels.front();
  if (largest > 0.0 && error > kLargest * largest) {
    throw Error("max error",
                "is more than 16 million times as far as the mesh reaches: another unit?");
  }
}

CoverOptions cover_options(const SimplifyOptions& options) {
  return {.method = options.method,
          .max_error = options.max_error,
          .zones = options.zones,
          .min_radius = options.min_radius,
          .min_internal_diameter = options.min_internal_diameter,
          .seed = options.seed,
          .effort = options.effort,
          .seconds = options.seconds,
          .lower_bound = options.lower_bound,
          .history = options.history,
          .threads = options.threads,
          .progress = options.progress,
          .on_proved = options.on_proved,
          .stop = options.stop};
}

}  // namespace

SimplifiedSolid internal::simplified_solid(const TriangleMesh& mesh, const MeshDistance& distance,
                                           const SimplifyOptions& options, std::size_t max_cells) {
  SimplifiedSolid result;
  SimplifyOptions& used = result.options = options;
  complete_levels(used);
  complete_lengths(used, mesh);
  check_size(used, distance);
  check_zones(used.zones, used.max_error,
              used.external == ExternalPlacement::kNone ? std::numeric_limits<double>::infinity()
                                                        : used.min_external_diameter);
  ExternalOptions stage1 = external_options(used);
  stage1.max_cells = max_cells;
  result.external = options.min_external_diameter == 0.0
                        ? place_with_default_diameter(mesh, distance, stage1)
                        : place_external_spheres(mesh, distance, stage1);
  result.larger_diameter = result.external.min_external_diameter > used.min_external_diameter;
  used.min_external_diameter = result.external.min_external_diameter;
  return result;
}

SimplifiedSolid simplified_solid(const TriangleMesh& mesh, const SimplifyOptions& options,
                                 std::size_t max_cells) {
  validate(mesh, "mesh");
  check_simplify_options(options);
  const internal::ThreadLimit threads(options.threads);
  return internal::simplified_solid(mesh, MeshDistance(mesh), options, max_cells);
}

Simplification simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  return internal::simplify(mesh, options, ExternalOptions::kMostCells);
}

Simplification internal::simplify(const TriangleMesh& mesh, const SimplifyOptions& options,
                                  std::size_t max_cells) {
  validate(mesh, "mesh");
  check_simplify_options(options);
  check_stage2_method(options);
  const internal::ThreadLimit threads(options.threads);

  const internal::Stopwatch external_time;
  const MeshDistance distance(mesh);
  SimplifiedSolid solid = internal::simplified_solid(mesh, distance, options, max_cells);
  Simplification result;
  result.external = std::move(solid.external);
  result.larger_diameter = solid.larger_diameter;
  result.options = std::move(solid.options);
  const SimplifyOptions& used = result.options;
  result.times.external = external_time.seconds();

  const internal::Stopwatch cover_time;
  const internal::Clearance clearance(result.external);
  result.cover = used.stage2_method
                     ? cover_solid(mesh, result.external, used)
                     : internal::cover(mesh, distance, clearance, cover_options(used));
  result.times.cover = cover_time.seconds();

  const internal::Stopwatch levels_time;
  if (used.levels.size() > 1) {
    const std::span<const double> coarser = std::span(used.levels).first(used.levels.size() - 1);
    CoverOptions level_options = cover_options(used);
    level_options.on_proved = {};
    result.levels =
        internal::fit_levels(distance, clearance, result.cover.spheres, coarser, level_options);
  }
  result.times.levels = levels_time.seconds();
  result.interrupted = used.stop.stop_requested();

  const internal::Stopwatch certify_time;
  CertifyOptions certify_options;
  certify_options.external = &result.external;
  certify_options.zones = used.zones;
  certify_options.resolution = proof_resolution(tightest_error(used.zones, used.max_error),
                                                internal::box_of(mesh).diagonal().norm());
  certify_options.threads = used.threads;
  certify_options.progress = used.progress;
  result.certificate =
      internal::certify(mesh, distance, clearance, result.cover.spheres, certify_options);
  result.times.certify = certify_time.seconds();
  return result;
}

SphereCover cover_solid(const TriangleMesh& mesh, const ExternalSpheres& external,
                        const SimplifyOptions& options) {
  check_stage2_method(options);
  const CoverOptions passed = cover_options(options);
  return options.stage2_method ? options.stage2_method->run(mesh, external, passed)
                               : cover(mesh, external, passed);
}

double proof_resolution(double max_error, double diagonal) {
  const double finest = CertifyOptions{}.resolution;
  if (!(max_error > 0.0 && diagonal > 0.0)) return finest;
  return std::min(finest, kResolutionOfError * max_error / diagonal);
}

namespace {

constexpr double kDefaultError = 0.01;    // of the box diagonal
constexpr double kDefaultDiameter = 4.0;  // of E: 90-degree edges need spheres of radius 2 E

}  // namespace

void complete_lengths(SimplifyOptions& options, const TriangleMesh& mesh) {
  if (options.max_error == 0.0) {
    options.max_error = kDefaultError * internal::box_of(mesh).diagonal().norm();
  }
  if (options.min_external_diameter == 0.0) {
    options.min_external_diameter = kDefaultDiameter * options.max_error;
  }
}

double tool_diameter(std::span<const Sphere> tool) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : tool) {
    if (!is_usable(sphere)) throw Error("tool", "a sphere is not usable");
    least = std::min(least, sphere.radius);
  }
  if (tool.empty()) throw Error("tool", "holds no sphere");
  if (least == 0.0) throw Error("tool", "has a sphere of radius 0: nothing is small enough for it");
  return 2.0 * least;
}

ExternalOptions external_options(const SimplifyOptions& options) {
  return {.placement = options.external,
          .min_external_diameter = options.min_external_diameter,
          .padding = options.padding,
          .max_error = options.max_error > 0.0 ? options.max_error
                                               : options.min_external_diameter / kDefaultDiameter,
          .tightness = options.tightness,
          .zones = options.zones,
          .keep_concave_edges = options.keep_concave_edges,
          .limit = options.external_limit,
          .seed = options.seed,
          .threads = options.threads,
          .progress = options.progress};
}

std::string broken_promises(const Simplification& simplification) {
  const Certificate& certificate = simplification.certificate;
  const SimplifyOptions& options = simplification.options;
  std::ostringstream out;
  out << std::setprecision(12);
  if (!certificate.covered) out << "the spheres are not proved to cover";
  // A least radius may force spheres to protrude further.
  if (options.min_radius > 0.0) return out.str();
  const auto begin = [&](double most) -> std::ostream& {
    return out << (out.str().empty() ? "the spheres are not proved" : ", nor")
               << " to protrude by at most " << most;
  };
  const std::optional<double>& protrusion = certificate.protrusion_over_simplified_max;
  if (!protrusion || !(*protrusion <= options.max_error)) {
    begin(options.max_error) << " from the simplified solid";
    if (protrusion) out << ", only by at most " << *protrusion;
  }
  for (std::size_t i = 0; i < options.zones.size(); ++i) {
    const std::optional<double>& error = options.zones[i].max_error;
    if (!error) continue;
    const bool known = i < certificate.protrusion_in_zones.size();
    if (known && certificate.protrusion_in_zones[i] <= *error) continue;
    begin(*error) << " in zone " << i;
    if (known) out << ", only by at most " << certificate.protrusion_in_zones[i];
  }
  for (const CoverLevel& level : simplification.levels) {
    if (level.protrusion <= level.max_error) continue;
    begin(level.max_error) << " in a level, only by at most " << level.protrusion;
  }
  return out.str();
}

SphereTree sphere_tree(const Simplification& simplification) {
  const std::vector<Sphere>& spheres = simplification.cover.spheres;
  if (simplification.levels.empty()) return build_tree(spheres);
  return level_tree(spheres, simplification.levels).tree;
}

SphereFile sphere_file(const Simplification& simplification, double scale) {
  return {.spheres = simplification.cover.spheres,
          .certificate = record(simplification.certificate),
          .options = option_record(simplification.options, scale),
          .interrupted = simplification.interrupted};
}

}  // namespace spherule
