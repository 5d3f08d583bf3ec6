// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Divides a polygon, whose corners are indices of vertices, into triangles that are turned as it
// is: a fan about its first corner where no triangle of that is turned over, as of any convex
// polygon; else by clipping ears (G. H. Meisters, "Polygons have ears", American Mathematical
// Monthly 82, 1975) in the projection along the axis that its normal is closest to. Bridges to
// holes, along which a polygon runs twice, are allowed. A polygon that crosses itself or has no
// area, of which nobody can say what it holds, stays a fan. Either way the triangles' winding
// number is that of the polygon, so that they cover a planar one. Nothing where it would take too
// long.
std::optional<std::vector<Eigen::Vector3i>> polygon_triangles(
    std::span<const Eigen::Vector3d> vertices, std::span<const int> corners);

}  // namespace spherule::internal
