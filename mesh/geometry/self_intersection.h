// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <array>
#include <cstddef>

namespace spherule::internal {

using Corners = std::array<Eigen::Vector3d, 3>;

// Whether two triangles have a point in common, touching included, up to rounding: gaps below about
// 1e-14 of their size count as touching. Of triangles without area it may say so wrongly.
bool triangles_meet(const Corners& a, const Corners& b);

struct SelfIntersections {
  std::size_t pairs = 0;
  bool stopped = false;  // there may be more
};

// Number of pairs of triangles without a common vertex that intersect. Counting stops at `limit`,
// and where the pairs that are close enough to be examined are more than linear in the triangles.
// Vertices must be welded.
SelfIntersections count_self_intersections(const TriangleMesh& mesh, std::size_t limit);

}  // namespace spherule::internal
