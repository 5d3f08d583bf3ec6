// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/proof.h"
#include "simplifier/proof/subdivision.h"
#include "simplifier/proof/surface_piece.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace spherule::internal {
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
