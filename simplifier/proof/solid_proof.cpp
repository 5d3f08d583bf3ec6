// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/proof.h"
#include "simplifier/proof/subdivision.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/furthest_outside.h"
#include "simplifier/solid/solid_query.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

struct Cell {
  BoxCell box;
  bool inside = false;  // wholly in S
};

}  // namespace

// G1 of S: a cell lies in a single sphere, as far as it is in S, or is halved; one that cannot be
// halved further is no proof.
CoverageProof prove_solid(const Clearance& clearance, const MeshDistance& distance,
                          const SpheresToProve& spheres, double finest,
                          const std::function<bool(const Vector3d&)>& is_witness,
                          const KnownLeak& known) {
  const double rounding = mesh_point_error(distance);
  const double least = std::max(kFinestPinch * finest, least_reach(clearance.box()));
  const auto examine = [&](Cell& cell) {
    Finding found;
    found.point = cell.box.center;
    const double reach = cell.box.reach();
    const NearestSphere gap = spheres.hierarchy.nearest(found.point);
    const Sphere* const nearest =
        gap.index < 0 ? nullptr : &spheres.spheres[static_cast<std::size_t>(gap.index)];
    found.upper = gap.upper;
    // Where no point of S in the cell is further than this from the centre of the nearest sphere.
    const auto is_settled = [&](double furthest) {
      found.upper = sub_up(furthest, nearest->radius);
      found.settled = furthest <= nearest->radius;
      return found.settled;
    };
    if (nearest != nullptr && is_settled(cell.box.furthest(nearest->center))) return found;
    bool center_inside = cell.inside;
    if (!cell.inside) {
      const CellState state = classify(clearance, cell.box);
      found.settled = state.outside;
      if (found.settled) return found;
      cell.inside = state.inside;
      center_inside = state.center_inside;
      if (nearest != nullptr && state.contact != nullptr && !cell.inside &&
          is_settled(furthest_outside(cell.box, nearest->center, *state.contact))) {
        return found;
      }
    }
    const auto note = [&](const Vector3d& point, double depth) {
      found.point = point;
      found.depth = depth;
    };
    if (center_inside) {
      note(cell.box.center, gap.lower);
      found.smallest = reach <= finest;
    } else {
      const std::optional<SolidPoint> stands_for =
          reach <= finest ? solid_point_for(clearance, distance, cell.box, {finest, finest})
                          : std::nullopt;
      found.smallest = stands_for || reach <= least;
      if (!stands_for) return found;
      const auto& [kind, point] = *stands_for;
      // External spheres may take away what they pierce of the mesh.
      if (kind == SolidPoint::Kind::kOnMesh && clearance(point).upper >= -rounding) {
        note(point, sub_down(spheres.hierarchy.nearest(point).lower, rounding));
      }
      if (kind == SolidPoint::Kind::kInSolid) note(point, spheres.hierarchy.nearest(point).lower);
    }
    return found;
  };
  const auto split = [](const Cell& cell, std::vector<Cell>& parts) {
    for (const BoxCell& half : cell.box.halves()) parts.push_back({half, cell.inside});
  };
  return Subdivision(std::vector{Cell{BoxCell::around(clearance.box())}}, finest, examine, split,
                     is_witness)
      .prove(known);
}

}  // namespace spherule::internal
