// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/repair.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/proof/protrusion.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/solid_cells.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::SolidCells;

// Shares of max_error.
constexpr double kCells = 0.7;         // half diagonal of the cells examined first
constexpr double kLeakReserve = 0.02;  // about a point that is found open

// Of points found open, after which all spheres that could matter about them grow fully.
constexpr int kRounds = 40;

constexpr double kLeastError = 0.01;  // chosen, of the box diagonal

void check(std::span<const Sphere> spheres, const RepairOptions& options) {
  internal::check_usable(spheres);
  if (options.max_error != 0.0) internal::check_max_error(options.max_error);
  if (options.effort < 0) throw Error("effort", "must not be negative");
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The largest radius of each sphere with which it protrudes by at most `max_error`, as certified
// (protrusion.h); its own if that is larger.
std::vector<double> limits_of(const internal::Clearance& clearance, const MeshDistance& distance,
                              std::span<const Sphere> spheres, const internal::LocalError& error) {
  std::vector<double> limits(spheres.size());
  internal::parallel_for(0, spheres.size(), [&](std::size_t i) {
    const Vector3d& c = spheres[i].center;
    const double depth = clearance(c).lower;
    const double allowed = error.allowance(c, std::max(0.0, depth));
    const double limit =
        depth >= 0.0 ? add_down(allowed, depth) : sub_down(allowed, distance(c).upper);
    limits[i] = std::max(spheres[i].radius, next_down(limit));
  });
  return limits;
}

std::vector<Sphere> joined(std::vector<Sphere> spheres, const std::vector<Sphere>& more) {
  spheres.insert(spheres.end(), more.begin(), more.end());
  return spheres;
}

// Radii with which the spheres cover S together with those `added`, which they do at their limits.
std::vector<Sphere> inflated_spheres(const internal::Clearance& clearance,
                                     const MeshDistance& distance, std::span<const Sphere> spheres,
                                     const std::vector<Sphere>& limit,
                                     const std::vector<Sphere>& added, double max_error,
                                     const internal::LocalError& error) {
  std::vector<double> limits;
  for (const Sphere& sphere : limit) limits.push_back(sphere.radius);
  internal::SphereInflation inflation(spheres, limits);
  const double spacing = internal::CoverFitter::leak_spacing(max_error);
  SolidCells cells(clearance, distance, error, max_error, kCells);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Sphere> inflated = inflation.spheres();
    const std::vector<Sphere> all = joined(inflated, added);
    const internal::SphereHierarchy hierarchy(all);
    const SolidCells::Leaks leaks =
        cells.find_leaks({all, hierarchy}, internal::CoverFitter::finest(max_error), spacing);
    if (leaks.empty()) return inflated;
    bool more = false;
    for (const auto* points : {&leaks.in_solid, &leaks.pinched}) {
      for (const Vector3d& p : *points) {
        // What was requested is not enough here: several spheres meet at the point.
        more = inflation.require(p, kLeakReserve * max_error) ||
               inflation.grow_fully_about(p, spacing) || more;
      }
    }
    if (!more) break;
    inflation.solve();
  }
  return limit;
}

}  // namespace

Repair repair(const TriangleMesh& mesh, const ExternalSpheres& external,
              std::span<const Sphere> spheres, const RepairOptions& options) {
  require_rounding_to_nearest();
  validate(mesh, "mesh");
  internal::check_external(external);
  check(spheres, options);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  const internal::Clearance clearance(external);
  Repair result;
  const std::vector<double> before = internal::protrusions_over_solid(clearance, distance, spheres);
  result.protrusion_before = internal::greatest(before);
  result.max_error =
      options.max_error > 0.0
          ? options.max_error
          : std::max(median(before), kLeastError * internal::box_of(mesh).diagonal().norm());
  check_zones(options.zones, result.max_error, std::numeric_limits<double>::infinity());
  const internal::LocalError error(result.max_error, options.zones);
  std::vector<Sphere> limit(spheres.begin(), spheres.end());
  const std::vector<double> limits = limits_of(clearance, distance, spheres, error);
  for (std::size_t i = 0; i < limit.size(); ++i) limit[i].radius = limits[i];
  const CoverOptions cover_options{.max_error = result.max_error,
                                   .zones = options.zones,
                                   .seed = options.seed,
                                   .effort = options.effort,
                                   .progress = options.progress};
  const std::vector<Sphere> added =
      internal::CoverFitter(clearance, distance, cover_options, limit).run().spheres;
  if (options.progress) options.progress(-1.0, "growing");
  result.spheres =
      inflated_spheres(clearance, distance, spheres, limit, added, result.max_error, error);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double by = result.spheres[i].radius - spheres[i].radius;
    if (by > 0.0) ++result.inflated;
    result.largest_inflation = std::max(result.largest_inflation, by);
    result.total_inflation += by;
  }
  result.added = added.size();
  result.spheres = joined(std::move(result.spheres), added);
  result.protrusion_after =
      internal::greatest(internal::protrusions_over_solid(clearance, distance, result.spheres));
  return result;
}

}  // namespace spherule
