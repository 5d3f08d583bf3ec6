// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Exact oracles of hulls; they share no code with the library.

#include "mesh/triangle_mesh.h"
#include "tests/spheretree/exact.h"

#include <array>
#include <cstddef>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace spherule::test {

using ExactPoint = std::array<Rational, 3>;

inline ExactPoint exact(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

// Sign of the determinant of b - a, c - a, p - a: positive if p lies beyond the triangle's outer
// side.
inline int exact_side(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                      const ExactPoint& p) {
  std::array<ExactPoint, 3> d;
  for (std::size_t k = 0; k < 3; ++k) {
    d[0][k] = b[k] - a[k];
    d[1][k] = c[k] - a[k];
    d[2][k] = p[k] - a[k];
  }
  const Rational value = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                         d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                         d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
  return value.sign();
}

// How many pairs of a triangle and a point have the point beyond the triangle's plane or on it.
inline std::size_t exact_outside(const TriangleMesh& hull,
                                 std::span<const Eigen::Vector3d> points) {
  std::vector<ExactPoint> exact_points;
  for (const Eigen::Vector3d& p : points) exact_points.push_back(exact(p));
  std::size_t count = 0;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const auto corner = [&](int k) { return exact(hull.vertices[static_cast<std::size_t>(t[k])]); };
    const ExactPoint a = corner(0), b = corner(1), c = corner(2);
    for (const ExactPoint& p : exact_points) count += exact_side(a, b, c, p) >= 0 ? 1 : 0;
  }
  return count;
}

// Every edge is used once in either direction, and Euler's formula holds for one sphere.
inline bool is_sphere(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  std::set<int> used;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      used.insert(t[k]);
      if (!edges.emplace(t[k], t[(k + 1) % 3]).second) return false;
    }
  }
  for (const auto& [from, to] : edges) {
    if (!edges.contains({to, from})) return false;
  }
  return used.size() == mesh.vertices.size() &&
         used.size() + mesh.triangles.size() == edges.size() / 2 + 2;
}

}  // namespace spherule::test
