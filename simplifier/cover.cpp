// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/internal/stages.h"
#include "simplifier/proof/protrusion.h"
#include "simplifier/simplify.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_blocks.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/paper/internal_spheres.h"
#include "simplifier/types/simplification.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace spherule {

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  internal::check_external(external);
  internal::check_options(options);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  return internal::cover(mesh, distance, internal::Clearance(external), options);
}

SphereCover internal::cover(const TriangleMesh& mesh, const MeshDistance& distance,
                            const internal::Clearance& clearance, const CoverOptions& options,
                            std::size_t most_cells) {
  require_rounding_to_nearest();
  check_options(options);
  const ThreadLimit threads(options.threads);
  if (options.method == CoverMethod::kPaper) {
    refuse_error_zones(options, "paper");
    return internal::place_internal_spheres(mesh, distance, clearance, options);
  }
  SphereCover result;
  const Stopwatch watch;
  std::optional<CoverFitter> fitter(std::in_place, clearance, distance, options);
  if (fitter->divided().size() > most_cells) {
    CoverBlocks blocks(clearance, distance, options, fitter->divided().boxes(), watch);
    fitter.reset();
    result.spheres = blocks.run();
    return result;
  }
  result.spheres = fitter->run().spheres;
  result.lower_bound = fitter->lower_bound();
  return result;
}

namespace {

constexpr double kLeastRatio = 1.01;  // of the errors of two levels

}  // namespace

std::vector<double> check_levels(std::span<const double> max_errors) {
  std::vector<double> sorted(max_errors.begin(), max_errors.end());
  for (const double error : sorted) {
    if (!(error > 0.0 && error <= kMaxCoordinate)) {
      throw Error("levels", "must be positive and finite");
    }
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    if (sorted[k] < kLeastRatio * sorted[k - 1]) {
      throw Error("levels", "each must be at least 1 % larger than the next finer one");
    }
  }
  return sorted;
}

std::vector<CoverLevel> fit_levels(const TriangleMesh& mesh, const ExternalSpheres& external,
                                   std::span<const Sphere> spheres,
                                   std::span<const double> max_errors,
                                   const CoverOptions& options) {
  validate(mesh, "mesh");
  internal::check_external(external);
  if (check_levels(max_errors).empty()) return {};
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  return internal::fit_levels(distance, internal::Clearance(external), spheres, max_errors,
                              options);
}

std::vector<CoverLevel> internal::fit_levels(const MeshDistance& distance,
                                             const internal::Clearance& clearance,
                                             std::span<const Sphere> spheres,
                                             std::span<const double> max_errors,
                                             const CoverOptions& options) {
  const std::vector<double> errors = check_levels(max_errors);
  std::vector<CoverLevel> levels;
  const ThreadLimit threads(options.threads);
  const auto protrusion = [&](std::span<const Sphere> of_level) {
    return greatest(protrusions_over_solid(clearance, distance, of_level));
  };
  const SphereTree clustering = build_tree(spheres);
  levels.reserve(errors.size());
  std::span<const Sphere> finer = spheres;
  for (const double error : errors) {
    if (options.progress) {
      options.progress(static_cast<double>(levels.size()) / static_cast<double>(errors.size()),
                       "fitting levels");
    }
    CoverOptions level_options = options;
    level_options.max_error = error;
    // With a limit in time the rounds have none.
    if (options.seconds > 0.0) {
      level_options.effort = std::min(options.effort, CoverOptions{}.effort);
    }
    CoverLevel level;
    level.max_error = error;
    level.spheres = LevelFitter(clearance, finer, level_options).run();
    level.protrusion = protrusion(level.spheres.spheres);
    const std::vector<Sphere> clusters = cut(clustering, level.spheres.spheres.size());
    level.clustering_count = clusters.size();
    level.clustering_protrusion = protrusion(clusters);
    levels.push_back(std::move(level));
    finer = levels.back().spheres.spheres;
  }
  return levels;
}

LevelTree level_tree(std::span<const Sphere> spheres, std::span<const CoverLevel> levels) {
  std::vector<SphereLevel> coarser;
  for (const CoverLevel& level : levels) coarser.push_back(level.spheres);
  return build_tree_from_levels(spheres, coarser);
}

}  // namespace spherule
