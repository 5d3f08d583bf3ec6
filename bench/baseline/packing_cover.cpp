// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/sphere_methods.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/paper/internal_spheres.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;

// A point of S and the sphere that grows from it.
struct Candidate {
  Vector3d point = Vector3d::Zero();
  Sphere sphere;
};

// The largest sphere first, ties in the order of the points.
std::vector<Candidate> candidates_of(const std::vector<Vector3d>& points,
                                     const internal::SphereInflater& grow,
                                     std::size_t& seeds_rejected) {
  std::vector<Candidate> candidates(points.size());
  std::atomic<std::size_t> rejected = 0;
  internal::parallel_for(0, points.size(), [&](std::size_t i) {
    std::size_t here = 0;
    candidates[i] = {points[i], grow(points[i], here)};
    rejected += here;
  });
  seeds_rejected += rejected;
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.sphere.radius > b.sphere.radius; });
  return candidates;
}

// Places the candidates whose points are still further than `limit` from the spheres.
void place(const std::vector<Candidate>& candidates, double limit, bool where_centers_are_held,
           internal::SphereSet& spheres) {
  for (const Candidate& c : candidates) {
    if (spheres.nearest(c.point).upper <= limit) continue;
    if (!where_centers_are_held && spheres.nearest(c.sphere.center).upper < 0.0) continue;
    spheres.add(c.sphere);
    internal::check_count(spheres.spheres().size());
  }
}

}  // namespace

SphereCover packing_cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                          const CoverOptions& options) {
  const internal::ThreadLimit threads(options.threads);
  if (options.progress) options.progress(-1.0, "growing spheres");
  const internal::SimplifiedSolid solid(mesh, external, options, "packing");
  SphereCover result;
  const std::vector<Candidate> candidates =
      candidates_of(solid.samples(mesh), internal::SphereInflater(solid.clearance, options),
                    result.seeds_rejected);
  const double limit = internal::kLoopLimit * options.max_error;
  internal::SphereSet spheres;
  place(candidates, limit, false, spheres);
  place(candidates, limit, true, spheres);
  internal::fill_gaps(solid.clearance, solid.distance, options, spheres, result.seeds_rejected);
  const internal::CoverageProof remaining = internal::remaining_error(
      solid.clearance, solid.distance, spheres.spheres(), options.max_error);
  internal::inflate(result, spheres.spheres(), std::min(limit, remaining.upper), options);
  return result;
}

SpherePacking pack_spheres(const TriangleMesh& mesh, const SpherePackingOptions& options) {
  internal::check_max_error(options.max_error);
  if (!(options.closed_below >= 0.0 && options.closed_below <= kMaxCoordinate)) {
    throw Error("closed below", "must be finite and not negative");
  }
  ExternalOptions external;
  external.min_external_diameter =
      options.closed_below > 0.0 ? options.closed_below : options.max_error / 2.0;
  // Finer than this only the slack of closing would be smaller (ExternalOptions::grid_step).
  external.grid_step = external.min_external_diameter / 4.0;
  external.tightness = ExternalOptions::kNoTightness;
  external.padding = options.padding;
  external.threads = options.threads;
  external.progress = options.progress;
  SpherePacking result;
  result.solid = place_external_spheres(mesh, external);
  CoverOptions loop;
  loop.method = CoverMethod::kPaper;
  loop.max_error = options.max_error;
  loop.min_internal_diameter = options.seed_diameter;
  loop.seed = options.seed;
  loop.history = options.history;
  loop.threads = options.threads;
  loop.progress = options.progress;
  SphereCover packed = cover(mesh, result.solid, loop);
  result.spheres = std::move(packed.spheres_before_inflation);
  result.inflated = std::move(packed.spheres);
  result.error = packed.inflation;
  result.history = std::move(packed.history);
  result.seeds_rejected = packed.seeds_rejected;
  return result;
}

}  // namespace spherule
