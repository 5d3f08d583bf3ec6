// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Distances in 50 decimal digits. The oracle shares no code with the library: it takes the least of
// the distances to the three edges and, where the foot of the perpendicular falls into the
// triangle, to the plane.

#include "geometry/triangle_mesh.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace spherule::test {

using Digits50 = boost::multiprecision::cpp_bin_float_50;

struct ExactVector {
  Digits50 x, y, z;
};

inline ExactVector exact_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {Digits50(a.x()) - b.x(), Digits50(a.y()) - b.y(), Digits50(a.z()) - b.z()};
}
inline Digits50 exact_dot(const ExactVector& a, const ExactVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline ExactVector exact_cross(const ExactVector& a, const ExactVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Digits50 exact_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const ExactVector d = exact_difference(a, b);
  return sqrt(exact_dot(d, d));
}

inline Digits50 exact_segment_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b) {
  const ExactVector ab = exact_difference(b, a);
  const ExactVector ap = exact_difference(p, a);
  const Digits50 length_squared = exact_dot(ab, ab);
  if (length_squared == 0) return exact_distance(p, a);
  const Digits50 along = exact_dot(ap, ab);
  if (along <= 0) return exact_distance(p, a);
  if (along >= length_squared) return exact_distance(p, b);
  const ExactVector n = exact_cross(ap, ab);
  return sqrt(exact_dot(n, n) / length_squared);
}

inline Digits50 exact_triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  Digits50 best = std::min({exact_segment_distance(p, a, b), exact_segment_distance(p, b, c),
                            exact_segment_distance(p, c, a)});
  const ExactVector ab = exact_difference(b, a);
  const ExactVector normal = exact_cross(ab, exact_difference(c, a));
  const Digits50 area_squared = exact_dot(normal, normal);
  if (area_squared == 0) return best;
  const std::array corners{&a, &b, &c};
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& from = *corners[k];
    const ExactVector inwards = exact_cross(normal, exact_difference(*corners[(k + 1) % 3], from));
    if (exact_dot(inwards, exact_difference(p, from)) < 0) return best;
  }
  const Digits50 height = abs(exact_dot(normal, exact_difference(p, a))) / sqrt(area_squared);
  return std::min(best, height);
}

// To the box of a triangle, in double: right but for some 1e-16 of itself.
inline double rough_box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                 const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Vector3d high = a.cwiseMax(b).cwiseMax(c);
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).stableNorm();
}

inline Digits50 exact_mesh_distance(const Eigen::Vector3d& p, const TriangleMesh& mesh) {
  // Triangles in the order of their boxes' distances, up to those that are clearly further.
  std::vector<std::pair<double, std::size_t>> boxes;
  const auto vertex = [&](std::size_t i, int k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    boxes.emplace_back(rough_box_distance(p, vertex(i, 0), vertex(i, 1), vertex(i, 2)), i);
  }
  std::ranges::sort(boxes);
  Digits50 best = -1;
  for (const auto& [box_distance, i] : boxes) {
    if (best >= 0 && box_distance * (1.0 - 1e-12) > best) break;
    const Digits50 d = exact_triangle_distance(p, vertex(i, 0), vertex(i, 1), vertex(i, 2));
    if (best < 0 || d < best) best = d;
  }
  return best;
}

}  // namespace spherule::test
