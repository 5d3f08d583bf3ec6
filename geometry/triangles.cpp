// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangles.h"

#include "base/rounding.h"
#include "geometry/point_triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr double kOverlap = 400.0 * kUnitRoundoff;

double longest(const std::array<Vector3d, 3>& edges) {
  return std::sqrt(
      std::max({edges[0].squaredNorm(), edges[1].squaredNorm(), edges[2].squaredNorm()}));
}

// Calls visit(axis) for the normals and the cross products of edges, until it returns true, which
// is then the answer.
template <class Visit>
bool any_axis(const std::array<Vector3d, 3>& edges_a, const std::array<Vector3d, 3>& edges_b,
              const Visit& visit) {
  if (visit(edges_a[0].cross(edges_a[1]))) return true;
  if (visit(edges_b[0].cross(edges_b[1]))) return true;
  for (const Vector3d& edge_a : edges_a) {
    for (const Vector3d& edge_b : edges_b) {
      if (visit(edge_a.cross(edge_b))) return true;
    }
  }
  return false;
}

// By how much the triangles must overlap along an axis, in units of its length.
double least_overlap(double length, double scene_size) {
  return kOverlap * scene_size * scene_size * length + kUnderflow;
}

// By the axes that are needed only where the generic ones are uncertain.
bool specially_apart(const Triangle& a, const Triangle& b, double pad) {
  const auto apart_along = [&](const Vector3d& axis) {
    return separates(axis, gap_along(axis, a, b), pad);
  };
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const std::array<Vector3d, 3> edges = edges_of(*one);
    const Vector3d normal = edges[0].cross(edges[1]);
    for (const Vector3d& edge : edges) {
      if (apart_along(normal.cross(edge))) return true;
    }
    for (const Vector3d& corner : *one) {
      const auto& [p, q, r] = *other;
      if (apart_along(corner - point_triangle_distance(corner, p, q, r).closest)) return true;
    }
  }
  return false;
}

}  // namespace

TriangleContact triangle_contact(const Triangle& a, const Triangle& b, double pad,
                                 double scene_size) {
  double widest = -std::numeric_limits<double>::infinity();
  const auto apart_along = [&](const Vector3d& axis) {
    const double gap = gap_along(axis, a, b);
    widest = std::max(widest, gap);
    return separates(axis, gap, pad);
  };
  const std::array<Vector3d, 3> edges_a = edges_of(a);
  const std::array<Vector3d, 3> edges_b = edges_of(b);
  if (any_axis(edges_a, edges_b, apart_along)) return TriangleContact::kApart;
  const double length = std::max(longest(edges_a), longest(edges_b));
  if (widest < -least_overlap(length, scene_size)) return TriangleContact::kTouch;
  return specially_apart(a, b, pad) ? TriangleContact::kApart : TriangleContact::kUncertain;
}

double triangle_depth(const Triangle& a, const Triangle& b, double scene_size) {
  const std::array<Vector3d, 3> edges_a = edges_of(a);
  const std::array<Vector3d, 3> edges_b = edges_of(b);
  const double length = std::max(longest(edges_a), longest(edges_b));
  const double least = least_overlap(length, scene_size);
  double depth = std::numeric_limits<double>::infinity();
  any_axis(edges_a, edges_b, [&](const Vector3d& axis) {
    const double size = axis.norm() * kRelativeUp + kOverlap * scene_size * length + kUnderflow;
    depth = std::min(depth, (-gap_along(axis, a, b) - least) / size);
    return depth <= 0.0;
  });
  return depth / kRelativeUp;
}

}  // namespace spherule::internal
