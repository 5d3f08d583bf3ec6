// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Exact oracles of hulls; they share no code with the library.

#include "geometry/triangle_mesh.h"
#include "tests/support/exact/spheres.h"

#include <array>
#include <cmath>
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

// The determinant of b - a, c - a, p - a and, as the sum of its terms without their signs, what its
// rounding is a share of.
template <class Number>
std::array<Number, 2> determinant_and_size(const std::array<Number, 3>& a,
                                           const std::array<Number, 3>& b,
                                           const std::array<Number, 3>& c,
                                           const std::array<Number, 3>& p) {
  std::array<std::array<Number, 3>, 3> d;
  for (std::size_t k = 0; k < 3; ++k) {
    d[0][k] = b[k] - a[k];
    d[1][k] = c[k] - a[k];
    d[2][k] = p[k] - a[k];
  }
  std::array<Number, 2> sums{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Number plus = d[0][k] * d[1][(k + 1) % 3] * d[2][(k + 2) % 3];
    const Number minus = d[0][k] * d[1][(k + 2) % 3] * d[2][(k + 1) % 3];
    sums[0] += plus - minus;
    sums[1] += plus < 0 ? -plus : plus;
    sums[1] += minus < 0 ? -minus : minus;
  }
  return sums;
}

// Sign of the determinant: positive if p lies beyond the triangle's outer side. In long double
// where that is clear: five roundings a product of differences, three of the sum, 2^-64 each.
inline int exact_side(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  using Rough = std::array<long double, 3>;
  const auto rough = [](const Eigen::Vector3d& v) { return Rough{v.x(), v.y(), v.z()}; };
  const auto [value, size] = determinant_and_size(rough(t[0]), rough(t[1]), rough(t[2]), rough(p));
  if (std::abs(value) > 0x1p-58L * size) return value > 0.0L ? 1 : -1;
  return determinant_and_size(exact(t[0]), exact(t[1]), exact(t[2]), exact(p))[0].sign();
}

// How many pairs of a triangle and a point have the point beyond the triangle's plane or on it.
inline std::size_t exact_outside(const TriangleMesh& hull,
                                 std::span<const Eigen::Vector3d> points) {
  std::size_t count = 0;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const auto corner = [&](int k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
    const std::array<Eigen::Vector3d, 3> triangle{corner(0), corner(1), corner(2)};
    for (const Eigen::Vector3d& p : points) count += exact_side(triangle, p) >= 0 ? 1 : 0;
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
