// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/paper/inscribed_spheres.h"

#include "simplifier/solid/medial_ascent.h"
#include "simplifier/stage2/cover_checks.h"
#include "spheretree/rounding.h"

#include <algorithm>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr double kLeastStep = 0.05;  // of E
// Shares of E: how near a sphere comes to its seed.
constexpr double kNearAtEnd = 0.9;
constexpr double kNearOnTheWay = 0.5;

}  // namespace

SphereInflater::SphereInflater(const Clearance& clearance, const CoverOptions& options)
    : clearance_(clearance),
      max_error_(options.max_error),
      seed_radius_((options.min_internal_diameter > 0.0 ? options.min_internal_diameter
                                                        : options.max_error / 2.0) /
                   2.0) {}

Sphere SphereInflater::operator()(const Vector3d& seed, std::size_t& rejected) const {
  if (clearance_(seed).lower < seed_radius_) ++rejected;
  const std::vector<AscentStep> path =
      ascend(clearance_, seed,
             {.first_step = std::max(seed_radius_, kLeastStep * max_error_),
              .least_step = std::min(seed_radius_, kLeastStep * max_error_)});
  const Sphere inflated = sphere_at(path.back().point);
  if (is_near(inflated, seed, kNearAtEnd)) return inflated;
  // The gap grows along the way, from at most zero; take the last position that keeps it small.
  for (auto it = path.rbegin() + 1; it != path.rend(); ++it) {
    const Sphere sphere = sphere_at(it->point);
    if (is_near(sphere, seed, kNearOnTheWay)) return sphere;
  }
  return {seed, std::max(0.0, clearance_(seed).lower)};
}

// Of negative radius where the centre is outside of S. Inflated, such a sphere would protrude by
// the way to S on top.
Sphere SphereInflater::sphere_at(const Vector3d& center) const {
  return {center, clearance_(center).lower};
}

bool SphereInflater::is_near(const Sphere& sphere, const Vector3d& point, double share) const {
  return sphere.radius >= 0.0 &&
         (point - sphere.center).norm() - sphere.radius <= share * max_error_;
}

void fill_gaps(const Clearance& clearance, const MeshDistance& distance,
               const CoverOptions& options, SphereSet& spheres, std::size_t& seeds_rejected,
               const SphereNote& note) {
  const double limit = kLoopLimit * options.max_error;
  UncoveredSearch search(clearance, distance, limit, kErrorTolerance * options.max_error);
  const SphereInflater grow(clearance, options);
  while (true) {
    const UncoveredSearch::Peak peak = search.next(spheres);
    if (peak.upper <= limit) return;
    const Sphere sphere = grow(peak.point, seeds_rejected);
    if (note) note(peak, sphere);
    spheres.add(sphere);
    check_count(spheres.spheres().size());
    if (options.progress) options.progress(-1.0, "placing internal spheres");
  }
}

CoverageProof remaining_error(const Clearance& clearance, const MeshDistance& distance,
                              const std::vector<Sphere>& spheres, double max_error) {
  const SphereHierarchy hierarchy(spheres);
  return prove_solid(clearance, distance, {spheres, hierarchy}, kErrorTolerance * max_error,
                     [](const Vector3d&) { return true; });
}

void inflate(SphereCover& cover, const std::vector<Sphere>& spheres, double error,
             const CoverOptions& options) {
  cover.spheres_before_inflation = spheres;
  cover.inflation = add_up(error, kProofMargin * options.max_error);
  cover.spheres.clear();
  for (const Sphere& s : spheres) {
    cover.spheres.push_back(
        {s.center, std::max(options.min_radius, add_up(s.radius, cover.inflation))});
  }
}

}  // namespace spherule::internal
