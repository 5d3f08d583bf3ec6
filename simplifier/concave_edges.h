// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Zones of a smaller D along concave edges.

#include "geometry/triangle_mesh.h"
#include "simplifier/types/zones.h"

#include <numbers>
#include <vector>

namespace spherule {

// The lengths of a fit, on which it depends which edges matter.
struct ConcaveEdgeOptions {
  double min_external_diameter = 0.0;  // D
  double max_error = 0.0;              // E
  double padding = 0.0;                // t
  // By how much spheres may keep clear of the surface where a grid places them.
  double margin = 0.0;
};

// Zones of a smaller D along the sharp concave edges of a mesh, where a sphere of diameter D leaves
// a fillet. An edge is sharp and concave if its angle, measured on the outside, is below 150
// degrees. With an outside angle theta a sphere of radius r stays r (1 / sin(theta / 2) - 1) away
// from the edge. The zones' d is the diameter with which that is E / 2, at least D / 4 (which is
// enough down to 60 degrees for D = 4 E) so that the grid stays payable; edges where D itself
// leaves no more than E / 2 get no zone. A zone is a capsule about edges one after the other, as
// long as they are straight within d / 8, wide enough to hold the centre of a sphere of radius D /
// 2 + `margin` that touches both sides, in M grown by t.
//
// Edges are matched by vertices that are equal bit for bit, and the outside is where the triangles'
// normals point (on the other side if the mesh as a whole has a negative volume). Where an edge has
// more than two triangles, or two that contradict each other, the smallest angle between any two of
// them counts, whichever side it opens to, unless it is below a degree: a zone that is not needed
// costs time only. Edges with one triangle, triangles of no area and triangles that were there
// before have no angle. In a fixed order.
std::vector<Zone> concave_edge_zones(const TriangleMesh& mesh, const ConcaveEdgeOptions& options);

}  // namespace spherule

namespace spherule::internal {

// An edge is sharp if the faces beside it form an angle of less than this, 150 degrees.
inline constexpr double kSharpAngle = 150.0 * (std::numbers::pi / 180.0);
inline constexpr double kCosineOfHalfSharp = 0.2588190451025207;

}  // namespace spherule::internal
