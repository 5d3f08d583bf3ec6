// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh_readers.h"

#include "base/error.h"
#include "io/polygon_triangles.h"

#include <limits>
#include <vector>

namespace spherule::internal {

void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject) {
  if (vertex_count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(subject, "more than 2^31 vertices");
  }
  if (corners.size() / 4 > vertex_count) {
    throw Error(subject, "a face of " + std::to_string(corners.size()) + " corners, with " +
                             std::to_string(vertex_count) + " vertices");
  }
  for (const std::int64_t corner : corners) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count) {
      throw Error(subject, "a face refers to vertex " + std::to_string(corner) + " (from 0) of " +
                               std::to_string(vertex_count));
    }
  }
  if (corners.size() == 3) {
    mesh.triangles.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[1]),
                                static_cast<int>(corners[2]));
    return;
  }
  std::vector<int> numbers;
  numbers.reserve(corners.size());
  for (const std::int64_t corner : corners) numbers.push_back(static_cast<int>(corner));
  const auto triangles = polygon_triangles(mesh.vertices, numbers);
  if (!triangles) {
    throw Error(subject, "a face of " + std::to_string(corners.size()) +
                             " corners that is not convex takes too long to divide into triangles");
  }
  mesh.triangles.insert(mesh.triangles.end(), triangles->begin(), triangles->end());
}

std::array<std::int64_t, 3> strip_triangle(std::span<const std::int64_t> strip, std::size_t last) {
  const std::size_t turned = last % 2;
  return {strip[last - 2 + turned], strip[last - 1 - turned], strip[last]};
}

}  // namespace spherule::internal
