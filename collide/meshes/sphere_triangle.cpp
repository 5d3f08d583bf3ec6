// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/sphere_triangle.h"

#include "mesh/geometry/separating_axis.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace spherule::internal {

using Eigen::Vector3d;

bool are_apart(const Vector3d& p, const std::array<Vector3d, 3>& triangle, double reach) {
  const Vector3d a = triangle[0] - p, b = triangle[1] - p, c = triangle[2] - p;
  const auto nearest = [&](const Vector3d& axis) {
    return std::min({axis.dot(a), axis.dot(b), axis.dot(c)});
  };
  const Vector3d ab = triangle[1] - triangle[0];
  const Vector3d normal = ab.cross(triangle[2] - triangle[0]);
  const double low = nearest(normal);
  const double high = std::max({normal.dot(a), normal.dot(b), normal.dot(c)});
  if (separates(normal, std::max(low, -high), reach)) return true;

  const std::array<Vector3d, 3> corners = {a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    const double square = edge.squaredNorm();
    if (square > 0.0) {
      const Vector3d foot = corners[i] - (corners[i].dot(edge) / square) * edge;
      if (separates(foot, nearest(foot), reach)) return true;
    }
    if (separates(corners[i], nearest(corners[i]), reach)) return true;
  }
  return false;
}

}  // namespace spherule::internal
