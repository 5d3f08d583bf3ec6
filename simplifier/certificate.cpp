// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/shells.h"
#include "simplifier/internal/stages.h"
#include "simplifier/proof/proof.h"
#include "simplifier/proof/protrusion.h"
#include "simplifier/simplify.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/types/simplification.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

namespace spherule {
namespace {

using Eigen::Vector3d;

// Of the largest coordinate.
constexpr double kLeastResolution = 0x1p-40;
// Of how far the spheres reach from the origin: the gap to the nearest is known to 2^-49 of that
// (LeastGap), and pieces below it would be halved without end.
constexpr double kRoundingOfGaps = 0x1p-47;
// Spheres that reach further, in terms of the largest coordinate of M and S, leave nothing to be
// proved: 2^-24 of that coordinate remains of the resolution.
constexpr double kFurthestReach = 0x1p24;
// Without external spheres, |M| is what a sphere of this share of the box diagonal cannot reach.
constexpr double kPointFlood = 1.0 / 128.0;

void check_options(std::span<const Sphere> spheres, const CertifyOptions& options) {
  require_rounding_to_nearest();
  internal::check_usable(spheres);
  if (!(options.resolution > 0.0 && options.resolution <= 1.0)) {
    throw Error("resolution", "must be above 0 and at most 1");
  }
  if (!(options.protrusion_tolerance >= 0.0 && options.protrusion_tolerance <= 1.0)) {
    throw Error("protrusion tolerance", "must be between 0 and 1");
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  check_zones(options.zones, kAny, kAny);
  if (!(options.padding >= 0.0 && options.padding <= kMaxCoordinate)) {
    throw Error("padding", "must be finite and not negative");
  }
}

// What certifies |M| itself: everything that a small sphere cannot reach from outside.
ExternalSpheres flood_closely(const TriangleMesh& mesh, const MeshDistance& distance,
                              double padding) {
  ExternalOptions options;
  options.min_external_diameter = kPointFlood * distance.box().diagonal().norm();
  options.grid_step = options.min_external_diameter / 2.0;
  options.tightness = ExternalOptions::kNoTightness;
  options.padding = padding;
  return internal::place_external_spheres(mesh, distance, options);
}

// Whether M grown by the padding is proved to be a subset of S: in the box, and met by no external
// sphere.
bool solid_holds_mesh(const MeshDistance& distance, const ExternalSpheres& external) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(sub_down(distance.box().min()[axis], external.padding) >= external.box.min()[axis] &&
          add_up(distance.box().max()[axis], external.padding) <= external.box.max()[axis])) {
      return false;
    }
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, external.spheres.size()), true,
      [&](const tbb::blocked_range<std::size_t>& range, bool free) {
        for (std::size_t i = range.begin(); i < range.end() && free; ++i) {
          const Sphere& sphere = external.spheres[i];
          free = sub_down(distance(sphere.center).lower, external.padding) >= sphere.radius;
        }
        return free;
      },
      std::logical_and<>());
}

// A piece of surface may cross from sphere to sphere where these have next to nothing in common,
// and then lies in no single one however small it is, while the cells of the solid end where the
// spheres do. What is proved of S holds for M if S holds M.
void bound_by_solid(internal::CoverageProof& surface, const internal::CoverageProof& solid,
                    const MeshDistance& distance, const ExternalSpheres& external) {
  if (surface.upper > solid.upper && solid_holds_mesh(distance, external)) {
    surface.upper = std::max(surface.lower, solid.upper);
  }
}

// How far the furthest sphere reaches from the origin.
double checked_reach(std::span<const Sphere> spheres, double largest_coordinate) {
  double reach = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    reach = std::max(reach, norm_upper(spheres[i].center) + spheres[i].radius);
    if (reach > kFurthestReach * largest_coordinate) {
      throw Error("sphere " + std::to_string(i),
                  "reaches more than 16 million times as far as the mesh: another unit?");
    }
  }
  return reach;
}

Certificate proved(const TriangleMesh& mesh, const MeshDistance& distance,
                   const ExternalSpheres& external, const internal::Clearance& clearance,
                   std::span<const Sphere> spheres, const CertifyOptions& options) {
  const double diagonal = distance.box().diagonal().norm();
  const double largest = std::max(internal::largest_coordinate(distance.box()),
                                  internal::largest_coordinate(external.box));
  const double reach = checked_reach(spheres, largest);
  const double finest = std::max({options.resolution * diagonal, kLeastResolution * largest,
                                  kRoundingOfGaps * reach, kUnderflow});
  const internal::SphereHierarchy hierarchy(spheres);
  const internal::SpheresToProve to_prove{spheres, hierarchy};

  Certificate result;
  result.sphere_count = spheres.size();
  if (options.progress) options.progress(-1.0, "proving the surface");
  internal::CoverageProof surface = internal::prove_surface(mesh, to_prove, finest);
  if (options.progress) options.progress(-1.0, "proving the solid");
  const internal::ClosedShells shells(mesh, distance);
  // Every point of S is a witness against S, and against |M| itself one that is proved to be
  // inside. So are points of the mesh, as computed, against |M| and against an S that holds the
  // mesh.
  const bool is_of_mesh = options.external == nullptr;
  const bool has_mesh = is_of_mesh || (surface.lower > 0.0 && solid_holds_mesh(distance, external));
  internal::KnownLeak known;
  if (has_mesh) known = {surface.lower, surface.deepest};
  const internal::CoverageProof solid = internal::prove_solid(
      clearance, distance, to_prove, finest,
      [&](const Vector3d& p) {
        return is_of_mesh ? shells.contain(p) : has_mesh || clearance(p).lower >= 0.0;
      },
      known);
  bound_by_solid(surface, solid, distance, external);
  result.surface_depth = {surface.lower, surface.upper};
  result.solid_depth = {solid.lower, solid.upper};
  result.uncovered_depth = {std::max(surface.lower, solid.lower),
                            std::max(surface.upper, solid.upper)};
  result.deepest_leak = solid.lower > surface.lower ? solid.deepest : surface.deepest;
  result.covered = result.uncovered_depth.upper == 0.0;
  result.pieces = surface.examined;
  result.cells = solid.examined;
  if (options.external != nullptr) {
    const std::vector<double> each = internal::protrusions_over_solid(clearance, distance, spheres);
    result.protrusion_over_simplified_max = internal::greatest(each);
    for (const Zone& zone : options.zones) {
      result.protrusion_in_zones.push_back(internal::greatest_in(zone, spheres, each));
    }
  }
  if (options.external != nullptr && external.closing_slack > 0.0) {
    result.closing_slack = external.closing_slack;
  }
  if (options.protrusion_tolerance > 0.0) {
    if (options.progress) options.progress(-1.0, "measuring the protrusion");
    result.protrusion_over_mesh = internal::protrusion_over_mesh(
        distance, shells, clearance, to_prove, options.protrusion_tolerance * diagonal);
  }
  if (options.volume && !spheres.empty() && shells.is_mesh_closed()) {
    result.volume_ratio = internal::estimate_volume_ratio(mesh, shells.roles(), spheres);
    if (options.external != nullptr) {
      const internal::EstimatedVolume filled =
          internal::estimate_filled_volume(mesh, shells.roles(), external);
      result.filled_volume = filled.volume;
      result.filled_volume_error = filled.error;
    }
  }
  return result;
}

}  // namespace

Certificate certify(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                    const CertifyOptions& options) {
  validate(mesh, "mesh");
  check_options(spheres, options);
  if (options.external != nullptr) internal::check_external(*options.external);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  if (options.external != nullptr) {
    return internal::certify(mesh, distance, internal::Clearance(*options.external), spheres,
                             options);
  }
  const ExternalSpheres own = flood_closely(mesh, distance, options.padding);
  return proved(mesh, distance, own, internal::Clearance(own), spheres, options);
}

Certificate internal::certify(const TriangleMesh& mesh, const MeshDistance& distance,
                              const internal::Clearance& clearance, std::span<const Sphere> spheres,
                              const CertifyOptions& options) {
  check_options(spheres, options);
  const ThreadLimit threads(options.threads);
  return proved(mesh, distance, *options.external, clearance, spheres, options);
}

CertificateRecord record(const Certificate& certificate) {
  CertificateRecord r;
  r.covered = certificate.covered;
  r.uncovered_depth_lower = certificate.uncovered_depth.lower;
  r.uncovered_depth_upper = certificate.uncovered_depth.upper;
  r.protrusion_over_simplified_max = certificate.protrusion_over_simplified_max;
  if (certificate.protrusion_over_mesh) {
    r.protrusion_over_mesh_max = certificate.protrusion_over_mesh->upper;
  }
  r.protrusion_in_zones = certificate.protrusion_in_zones;
  r.sphere_count = certificate.sphere_count;
  r.volume_ratio = certificate.volume_ratio;
  r.filled_volume = certificate.filled_volume;
  r.filled_volume_error = certificate.filled_volume_error;
  r.closing_slack = certificate.closing_slack;
  return r;
}

}  // namespace spherule
