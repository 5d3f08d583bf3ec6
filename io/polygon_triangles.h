// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Triangulates a polygon, whose corners are indices of vertices, and keeps its orientation: a
// triangle fan about its first corner where no triangle of that is reversed, as for any convex
// polygon; else ear clipping (G. H. Meisters, "Polygons have ears", American Mathematical Monthly
// 82, 1975) in the projection along the axis that is closest to its normal. Bridges to holes, edges
// that the polygon runs along twice, are allowed. A polygon that intersects itself or has no area
// stays a fan. Either way the winding number of the triangles is that of the polygon, so that they
// cover a planar one. Nothing where it would take too long.
std::optional<std::vector<Eigen::Vector3i>> polygon_triangles(
    std::span<const Eigen::Vector3d> vertices, std::span<const int> corners);

}  // namespace spherule::internal
