// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/box_cell.h"
#include "simplifier/internal/proof.h"
#include "simplifier/internal/subdivision.h"
#include "spheretree/rounding.h"

#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

struct Cell {
  BoxCell box;
  bool inside = false;  // wholly in S
};

void halve(const Cell& cell, std::vector<Cell>& parts) {
  for (const BoxCell& half : cell.box.halves()) parts.push_back({half, cell.inside});
}

}  // namespace

CoverageProof prove_solid(const Clearance& clearance, const MeshDistance& distance,
                          const BallsToProve& balls, double finest,
                          const std::function<bool(const Vector3d&)>& is_witness) {
  // How far a point found on the mesh may be from it.
  const double rounding =
      256.0 * kUnitRoundoff *
      distance.box().min().cwiseAbs().cwiseMax(distance.box().max().cwiseAbs()).maxCoeff();
  const auto examine = [&](Cell& cell) {
    Finding found;
    found.point = cell.box.center;
    const double reach = cell.box.reach();
    const NearestBall gap = balls.hierarchy.nearest(found.point);
    if (gap.index >= 0 &&
        certainly_contains(balls.balls[static_cast<std::size_t>(gap.index)], found.point, reach)) {
      found.settled = true;
      return found;
    }
    bool center_inside = cell.inside;
    if (!cell.inside) {
      const ClearanceAt at = clearance(found.point, 0.125 * reach, 2.0 * reach);
      found.settled = at.upper <= -reach;
      cell.inside = at.lower >= reach;
      center_inside = at.lower >= 0.0;
    }
    if (center_inside) {
      found.depth = gap.lower;
      found.witness = gap.lower > 0.0 && is_witness(found.point);
    }
    if (!center_inside && reach <= finest) {
      // S may be as thin as the mesh itself, which is in it.
      const SurfaceDistance near = distance(found.point, reach);
      if (near.triangle >= 0) {
        found.point = near.closest;
        found.depth = sub_down(balls.hierarchy.nearest(near.closest).lower, rounding);
        found.witness = found.depth > 0.0 && is_witness(found.point);
        center_inside = true;
      }
    }
    found.smallest = reach <= (center_inside ? finest : kFinestOutside * finest);
    found.upper = add_up(gap.upper, reach);
    return found;
  };
  return Subdivision<Cell, decltype(examine), decltype(&halve)>(finest, examine, &halve)
      .prove({{BoxCell::around(clearance.box())}});
}

}  // namespace spherule::internal
