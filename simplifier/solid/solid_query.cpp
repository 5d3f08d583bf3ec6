// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/solid_query.h"

#include "base/rounding.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <algorithm>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Steps towards S are at least this share of it.
constexpr double kLeastStep = 1.0 / 32.0;
// Of directions that are tried from a point.
constexpr int kMostDirections = 24;

}  // namespace

double least_reach(const Eigen::AlignedBox3d& box) {
  return 256.0 * kUnitRoundoff * largest_coordinate(box);
}

CellState classify(const Clearance& clearance, const BoxCell& cell) {
  const double reach = cell.reach();
  return state_of(clearance(cell.center, 2.0 * reach), reach);
}

std::optional<Vector3d> mesh_point_in(const MeshDistance& distance, const BoxCell& cell) {
  const SurfaceDistance near = distance(cell.center, cell.reach());
  if (near.triangle < 0) return std::nullopt;
  return near.closest;
}

double mesh_point_error(const MeshDistance& distance) {
  return 256.0 * kUnitRoundoff * largest_coordinate(distance.box());
}

std::optional<Vector3d> solid_point_near(const Clearance& clearance, const BoxCell& cell,
                                         double within) {
  const double reach = cell.reach();
  for (const AscentStep& step :
       ascend(clearance, cell.center, {.first_step = reach, .least_step = kLeastStep * reach})) {
    if (distance_upper(cell.center, step.point) > within) break;
    if (step.clearance >= 0.0) return step.point;
  }
  return std::nullopt;
}

// Where external spheres meet at an acute angle, S is a groove whose edge the steps of an ascent,
// away from one contact at a time, do not leave. Straight lines do: in the direction of the
// shortest vector of the convex hull of the contacts' normals, the least rate at which the
// clearances to them increase is greatest. It is approached by one contact at a time, the one whose
// clearance increases least of those found along the line (Gilbert's algorithm).
std::optional<Vector3d> solid_point_in_groove(const Clearance& clearance, const Vector3d& start,
                                              double first_step, double within) {
  Vector3d shortest = clearance(start).away;
  for (int i = 0; i < kMostDirections && shortest.norm() > kLeastNorm; ++i) {
    const Vector3d direction = shortest.normalized();
    Vector3d least = shortest;
    for (double step = first_step; step <= within && least.dot(direction) > 0.0; step *= 2.0) {
      const Vector3d point = start + step * direction;
      if (distance_upper(start, point) > within) break;
      const ClearanceAt at = clearance(point);
      if (at.lower >= 0.0) return point;
      if (at.away.dot(direction) < least.dot(direction)) least = at.away;
    }
    const Vector3d change = least - shortest;
    if (change.norm() <= kLeastNorm) return std::nullopt;
    shortest += std::clamp(-shortest.dot(change) / change.squaredNorm(), 0.0, 1.0) * change;
  }
  return std::nullopt;
}

std::optional<SolidPoint> solid_point_for(const Clearance& clearance, const MeshDistance& distance,
                                          const BoxCell& cell, const SolidPointSearch& search,
                                          const std::function<bool(const Vector3d&)>& accepts) {
  using Kind = SolidPoint::Kind;
  const double reach = cell.reach();
  const auto on_mesh = mesh_point_in(distance, cell);
  if (on_mesh && (!accepts || accepts(*on_mesh))) return SolidPoint{Kind::kOnMesh, *on_mesh};
  if (reach > kFinestOutside * search.finest) return std::nullopt;
  if (const auto near = solid_point_near(clearance, cell, search.within)) {
    return SolidPoint{Kind::kInSolid, *near};
  }
  if (reach > std::max(kFinestPinch * search.finest, least_reach(clearance.box()))) {
    return std::nullopt;
  }
  if (search.grooves) {
    if (const auto near = solid_point_in_groove(clearance, cell.center, reach, search.within)) {
      return SolidPoint{Kind::kInSolid, *near};
    }
  }
  return SolidPoint{Kind::kPinch, cell.center};
}

}  // namespace spherule::internal
