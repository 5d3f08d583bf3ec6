// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/hubbard_spheres.h"

#include "base/error.h"
#include "base/threads.h"
#include "bench/baseline/internal/medial_spheres.h"
#include "bench/baseline/internal/mesh_probe.h"
#include "bench/baseline/internal/sampling_checks.h"
#include "bench/baseline/internal/sphere_reduction.h"
#include "bench/baseline/internal/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace spherule {
namespace {

void check(const HubbardOptions& options) {
  if (options.counts.empty() || options.counts.front() < 1 ||
      std::adjacent_find(options.counts.begin(), options.counts.end(), std::greater_equal<>()) !=
          options.counts.end()) {
    throw Error("counts", "must ascend from at least 1");
  }
  internal::check_samples("sites", options.sites);
  internal::check_samples("cover points", options.cover_points);
  internal::check_threads(options.threads);
}

}  // namespace

SphereLevels hubbard_spheres(const TriangleMesh& mesh, const HubbardOptions& options) {
  check(options);
  validate(mesh, "mesh");
  const internal::ThreadLimit limit(options.threads);
  const internal::MeshProbe probe(mesh);
  const std::vector<Eigen::Vector3d> samples =
      internal::cover_samples(mesh, options.cover_points, 1, options.seed);
  const internal::MedialAxis axis(probe,
                                  internal::even_samples(mesh, options.sites, 0, options.seed + 1));
  std::vector<std::uint32_t> points(samples.size());
  std::iota(points.begin(), points.end(), 0U);

  // No medial sphere grows by more than the radius that its share of the surface has.
  const double max_inflation = std::sqrt(
      internal::total_area(mesh) / (std::numbers::pi * static_cast<double>(options.counts.back())));
  const std::vector<std::size_t> descending(options.counts.rbegin(), options.counts.rend());
  auto merged =
      internal::merge_levels({probe, samples, points, axis.spheres(), max_inflation}, descending);
  std::reverse(merged.begin(), merged.end());
  SphereLevels result;
  for (const std::vector<internal::FittedSphere>& level : merged) {
    std::vector<Sphere>& spheres = result.levels.emplace_back();
    for (const internal::FittedSphere& s : level) spheres.push_back(s.sphere);
    if (result.levels.size() == 1) continue;
    std::vector<std::int32_t>& parents = result.parents.emplace_back();
    for (const internal::FittedSphere& s : level) parents.push_back(s.merged_into);
  }
  return result;
}

}  // namespace spherule
