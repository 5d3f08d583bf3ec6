// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/protrusion.h"

#include "mesh/geometry/mesh_box.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/solid/nearest_sphere.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr double kRelativeTolerance = 0.02;

// Distance from `c` to some point of S.
double distance_to_solid(const Clearance& clearance, const MeshDistance& distance,
                         const Vector3d& c, double radius) {
  double nearest = distance(c).upper;
  for (const AscentStep& step :
       ascend(clearance, c, {.first_step = 0.01 * radius, .least_step = 1e-4 * radius})) {
    if (step.clearance >= 0.0) nearest = std::min(nearest, distance_upper(c, step.point));
  }
  if (const auto near = solid_point_in_groove(clearance, c, 0x1p-30 * nearest, nearest)) {
    nearest = std::min(nearest, distance_upper(c, *near));
  }
  return nearest;
}

struct Cell {
  BoxCell box;
  double upper;  // no point of the spheres in the cell is further from |M|
  bool outside;  // known to be free of M and in no shell
};

bool below(const Cell& a, const Cell& b) {
  return a.upper < b.upper;
}

struct SpheresBound {
  double upper;      // no sphere protrudes further over |M|
  Vector3d witness;  // a point of the sphere that may protrude as far
};

// The open sphere about a centre in |M| that just touches M lies in |M|, so that no point of the
// sphere itself protrudes by more than r - d. The witness is the point of the sphere that is
// furthest along the direction to the nearest point of M or, where the centre is outside, against
// it. It falls short of the sphere by 32 u of the radius and the largest coordinate: certainly_
// contains() charges 8 u, the direction and its product take 6 u, the coordinates of the sum 2 u.
SpheresBound bound_of_spheres(const MeshDistance& distance, const ClosedShells& shells,
                              std::span<const Sphere> spheres) {
  // Nearer to M, rounding may take the shells for either side.
  const double mesh_error = mesh_point_error(distance);
  const auto is_inside = [&](const Vector3d& center, const SurfaceDistance& d) {
    return d.lower > mesh_error && shells.contain(center);
  };
  std::vector<double> each(spheres.size());
  parallel_for(0, spheres.size(), [&](std::size_t i) {
    const auto& [center, radius] = spheres[i];
    const SurfaceDistance d = distance(center);
    each[i] = is_inside(center, d) ? sub_up(radius, d.lower) : add_up(radius, d.upper);
  });
  const auto furthest = std::ranges::max_element(each);
  const Sphere& sphere = spheres[static_cast<std::size_t>(furthest - each.begin())];
  SpheresBound result{std::max(*furthest, 0.0), sphere.center};
  const SurfaceDistance d = distance(sphere.center);
  const Vector3d way = d.closest - sphere.center;
  if (way.norm() < kLeastNorm) return result;
  const Vector3d direction = (is_inside(sphere.center, d) ? 1.0 : -1.0) * way.normalized();
  const double short_by = 32.0 * kUnitRoundoff * (sphere.radius + sphere.center.norm());
  const Vector3d tip = sphere.center + (sphere.radius - short_by) * direction;
  if (certainly_contains(sphere, tip)) result.witness = tip;
  return result;
}

}  // namespace

// G2. About a centre in S the sphere whose radius is the clearance d lies in S, and no point of the
// sphere is further from it than r - d; elsewhere none is further than r from the centre, which is
// at some distance from S.
std::vector<double> protrusions_over_solid(const Clearance& clearance, const MeshDistance& distance,
                                           std::span<const Sphere> spheres) {
  std::vector<double> each(spheres.size());
  parallel_for(0, spheres.size(), [&](std::size_t i) {
    const Sphere& sphere = spheres[i];
    const double d = clearance(sphere.center).lower;
    each[i] = d >= 0.0 ? sub_up(sphere.radius, d)
                       : add_up(sphere.radius, distance_to_solid(clearance, distance, sphere.center,
                                                                 sphere.radius));
  });
  return each;
}

double greatest(std::span<const double> protrusions) {
  return std::accumulate(protrusions.begin(), protrusions.end(), 0.0,
                         [](double a, double b) { return std::max(a, b); });
}

double greatest_in(const Zone& zone, std::span<const Sphere> spheres,
                   std::span<const double> protrusions) {
  double result = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (spheres[i].radius < distance_lower(zone.shape, spheres[i].center)) continue;
    result = std::max(result, protrusions[i]);
  }
  return result;
}

Bounds protrusion_over_mesh(const MeshDistance& distance, const ClosedShells& shells,
                            const Clearance& clearance, const SpheresToProve& spheres,
                            double tolerance) {
  Bounds result;
  if (spheres.spheres.empty()) return result;
  const SpheresBound bound = bound_of_spheres(distance, shells, spheres.spheres);
  const Eigen::AlignedBox3d box = box_of(spheres.spheres);
  const double least = least_reach(box);
  std::vector<Cell> heap{{BoxCell::around(box), bound.upper, false}};
  // The greatest distance met in the spheres at a point that is not known to be inside: where the
  // search for the upper bound may stop. It goes on for the lower one, whose witnesses are outside
  // of S, while the inside of an open mesh has been examined by then.
  double met = 0.0;
  bool is_bounded = false;
  const auto is_near = [tolerance](double upper, double lower) {
    return upper <= lower + std::max(tolerance, kRelativeTolerance * lower);
  };
  const auto note = [&](const Vector3d& point, double away, bool is_outside) {
    if (away > met && (is_outside || !shells.contain(point))) met = away;
    if (away > result.lower && clearance(point).upper < 0.0) result.lower = away;
  };
  note(bound.witness, distance(bound.witness).lower, false);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), below);
    Cell cell = heap.back();
    heap.pop_back();
    const Vector3d& q = cell.box.center;
    const double reach = cell.box.reach();
    // Before its bound is made tighter: no cell that is left has a greater one.
    if (!is_bounded && (is_near(cell.upper, met) || reach <= least)) {
      result.upper = std::max(cell.upper, 0.0);
      is_bounded = true;
    }
    if (is_bounded && is_near(cell.upper, result.lower)) break;
    const NearestSphere gap = spheres.hierarchy.nearest(q);
    if (gap.lower > reach) continue;
    const SurfaceDistance d = distance(q);
    if (!cell.outside && d.lower > reach) {
      if (shells.contain(q)) continue;
      cell.outside = true;
    }
    cell.upper = std::min(cell.upper, add_up(d.upper, reach));
    if (gap.upper <= 0.0) note(q, d.lower, cell.outside);
    // Small cells are left as they are: S may come to a point that no centre gets beyond.
    if (is_bounded && (reach <= std::max(tolerance / 2.0, least) || clearance(q).lower >= reach)) {
      continue;
    }
    for (const BoxCell& half : cell.box.halves()) {
      heap.push_back({half, cell.upper, cell.outside});
      std::push_heap(heap.begin(), heap.end(), below);
    }
  }
  return result;
}

}  // namespace spherule::internal
