// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

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

// The edges of triangles, which are three indices of vertices each: Eigen::Vector3i or
// std::array<int, 3>.

template <typename Triangle>
bool has_repeated_corner(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// A use of an edge by a triangle, which runs along it from the vertex `low` to `high` or back.
struct EdgeUse {
  int low, high;  // vertices
  int triangle;
  int turn;  // +1 from low to high, -1 back

  int from() const { return turn > 0 ? low : high; }
  int to() const { return turn > 0 ? high : low; }
};

// Of the triangle that uses the edge.
template <typename Triangle>
int opposite_corner(const Triangle& t, const EdgeUse& edge) {
  return *std::find_if(t.begin(), t.end(),
                       [&](int corner) { return corner != edge.low && corner != edge.high; });
}

// By edge, and for each edge in the order of the triangles. A triangle with a repeated corner runs
// along an edge and back: as a chain it is zero, and it is left out.
template <typename Triangle>
std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (has_repeated_corner(t)) continue;
    const int corners[] = {t[0], t[1], t[2]};
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = corners[k], to = corners[(k + 1) % 3];
      uses.push_back(
          {std::min(from, to), std::max(from, to), static_cast<int>(i), from < to ? 1 : -1});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

// Calls the function with the uses of each edge, of what edge_uses() returned.
template <typename Function>
void for_each_edge(std::span<const EdgeUse> uses, const Function& function) {
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) {
      ++end;
    }
    function(uses.subspan(i, end - i));
  }
}

}  // namespace spherule::internal
