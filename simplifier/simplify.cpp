// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "mesh/geometry/mesh_box.h"
#include "mesh/mesh_report.h"
#include "simplifier/internal/stages.h"
#include "simplifier/support/stopwatch.h"
#include "simplifier/support/thread_limit.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

}  // namespace spherule
