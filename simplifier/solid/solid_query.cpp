// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/solid_query.h"

#include "simplifier/solid/medial_ascent.h"
#include "spheretree/rounding.h"

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Steps towards S are at least this share of it.
constexpr double kLeastStep = 1.0 / 32.0;

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

}  // namespace spherule::internal
