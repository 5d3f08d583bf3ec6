// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
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

// Appends the triangles of a polygon, whose vertices are there. Points and lines (fewer than three
// corners) are no surface and are left out. Throws Error for an index that is not below
// `vertex_count`, for more corners than four times as many (no polygon comes by its vertices that
// often, even where bridges lead to its holes), and for a polygon that takes too long to divide.
void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject);

// The triangle of a strip that ends at corner `last`, from 2 on: with the two corners before it,
// every second one flipped, so that all are oriented alike.
std::array<std::int64_t, 3> strip_triangle(std::span<const std::int64_t> strip, std::size_t last);

}  // namespace spherule::internal
