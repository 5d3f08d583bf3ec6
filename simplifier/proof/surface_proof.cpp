// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/proof.h"
#include "simplifier/proof/subdivision.h"
#include "simplifier/proof/surface_piece.h"
#include "spheretree/rounding.h"

#include <algorithm>
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
    const auto& [a, b, c] = piece.corner;
    Finding found;
    found.point = (a + b + c) / 3.0;
    const NearestSphere gap = spheres.hierarchy.nearest(found.point);
    if (gap.index >= 0) {
      const Sphere& sphere = spheres.spheres[static_cast<std::size_t>(gap.index)];
      found.settled = std::ranges::all_of(
          piece.corner, [&](const Vector3d& p) { return certainly_contains(sphere, p, error); });
    }
    const double radius = std::max({distance_upper(found.point, a), distance_upper(found.point, b),
                                    distance_upper(found.point, c)});
    found.smallest = radius <= finest;
    found.upper = add_up(gap.upper, add_up(radius, error));
    found.depth = sub_down(gap.lower, error);
    found.witness = true;
    return found;
  };
  std::vector<SurfacePiece> pieces;
  pieces.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    pieces.push_back({{vertex(0), vertex(1), vertex(2)}});
  }
  return Subdivision<SurfacePiece, decltype(examine), decltype(&halve)>(finest, examine, &halve)
      .prove(pieces);
}

}  // namespace spherule::internal
