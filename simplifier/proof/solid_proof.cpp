// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/solid_query.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
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

namespace {

using Eigen::Vector3d;

// What halving costs the proof of G1. A midpoint is off by at most sqrt(3) u times the largest
// coordinate, and the midpoint of points that are off by some amount is off by no more than that
// plus one rounding. After n halvings of longest edges no edge is longer than sqrt(3) 2^(-n/2) of
// the first (Stynes 1980), which is at most 2 sqrt(3) of the largest coordinate; so 86 halvings
// come below 2^-40 of that, the least `finest`, and 256 u times the largest coordinate bounds how
// far the pieces are from tiling the triangle.
double subdivision_error(const TriangleMesh& mesh) {
  double magnitude = 0.0;
  for (const Vector3d& v : mesh.vertices) magnitude = std::max(magnitude, v.cwiseAbs().maxCoeff());
  return 256.0 * kUnitRoundoff * magnitude;
}

}  // namespace

CoverageProof prove_surface(const TriangleMesh& mesh, const SpheresToProve& spheres,
                            double finest) {
  const double error = subdivision_error(mesh);
  const auto examine = [&](const SurfacePiece& piece) {
    Finding found;
    found.point = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3.0;
    found.smallest = furthest_corner(piece, found.point).distance <= finest;
    const NearestSphere gap = spheres.hierarchy.nearest(found.point);
    found.upper = gap.upper;
    found.depth = gap.lower;
    if (gap.index < 0) return found;
    found.depth = sub_down(gap.lower, error);
    const Sphere& sphere = spheres.spheres[static_cast<std::size_t>(gap.index)];
    const auto [corner, corner_distance] = furthest_corner(piece, sphere.center);
    const double reach = add_up(corner_distance, error);
    found.settled = reach <= sphere.radius;
    if (found.settled) return found;
    found.upper = sub_up(reach, sphere.radius);
    const double depth = sub_down(spheres.hierarchy.nearest(corner).lower, error);
    if (depth > found.depth) {
      found.depth = depth;
      found.point = corner;
    }
    return found;
  };
  std::vector<SurfacePiece> pieces;
  pieces.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) pieces.push_back({corners_of(mesh, t)});
  const auto split = [](const SurfacePiece& piece, std::vector<SurfacePiece>& parts) {
    halve(piece, parts);
  };
  return Subdivision(std::move(pieces), finest, examine, split,
                     [](const Vector3d&) { return true; })
      .prove();
}

}  // namespace spherule::internal
