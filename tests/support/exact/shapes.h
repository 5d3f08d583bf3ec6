// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Distances of segments, triangles, meshes and solids, in whatever numbers are exact enough:
// rational ones for the question whether two triangles touch. Nothing is assumed of the triangles,
// and no code is shared with the library.

#include "collide/solids/primitive.h"
#include "geometry/triangle_mesh.h"
#include "tests/support/exact/spheres.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace spherule::test {

template <class Number>
using ExactTriangle = std::array<Vector<Number>, 3>;

template <class Number>
ExactTriangle<Number> placed(const Pose& pose, const std::array<Eigen::Vector3d, 3>& triangle) {
  return {transform(pose, exact<Number>(triangle[0])), transform(pose, exact<Number>(triangle[1])),
          transform(pose, exact<Number>(triangle[2]))};
}

template <class Number>
Number squared_distance_to_segment(const Vector<Number>& p, const Vector<Number>& a,
                                   const Vector<Number>& b) {
  const Vector<Number> ab = difference(b, a);
  const Number length = dot(ab, ab);
  Number t = 0;
  if (length > 0) t = dot(difference(p, a), ab) / length;
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  return squared_distance(p, plus(a, t, ab));
}

// The foot on the plane where it lies inside the triangle, else the nearest edge.
template <class Number>
Number squared_distance_to_triangle(const Vector<Number>& p, const ExactTriangle<Number>& t) {
  const Vector<Number> ab = difference(t[1], t[0]);
  const Vector<Number> ac = difference(t[2], t[0]);
  const Vector<Number> ap = difference(p, t[0]);
  const Number bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  const Number determinant = bb * cc - bc * bc;
  if (determinant > 0) {
    const Number v = (cc * dot(ap, ab) - bc * dot(ap, ac)) / determinant;
    const Number w = (bb * dot(ap, ac) - bc * dot(ap, ab)) / determinant;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      return squared_distance(p, plus(plus(t[0], v, ab), w, ac));
    }
  }
  Number least = squared_distance_to_segment(p, t[0], t[1]);
  for (std::size_t k = 1; k < 3; ++k) {
    const Number other = squared_distance_to_segment(p, t[k], t[(k + 1) % 3]);
    if (other < least) least = other;
  }
  return least;
}

// Whether the two ends lie strictly on both sides of the triangle's plane, and it passes through
// the triangle.
template <class Number>
bool pierces(const Vector<Number>& p, const Vector<Number>& q, const ExactTriangle<Number>& t) {
  const Vector<Number> normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  const Number of_p = dot(normal, difference(p, t[0]));
  const Number of_q = dot(normal, difference(q, t[0]));
  if (of_p * of_q >= 0) return false;
  const Number share = of_p / (of_p - of_q);
  const Vector<Number> x = plus(p, share, difference(q, p));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<Number> side = cross(difference(t[(k + 1) % 3], t[k]), difference(x, t[k]));
    if (dot(normal, side) < 0) return false;
  }
  return true;
}

// Two triangles that touch not are nearest at a corner of one of them or within two edges.
template <class Number>
Number squared_distance(const ExactTriangle<Number>& a, const ExactTriangle<Number>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return 0;
  }
  Number least = squared_distance_to_triangle(a[0], b);
  const auto take = [&](const Number& other) {
    if (other < least) least = other;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    take(squared_distance_to_triangle(a[i], b));
    take(squared_distance_to_triangle(b[i], a));
    const Vector<Number> along_a = difference(a[(i + 1) % 3], a[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector<Number> along_b = difference(b[(j + 1) % 3], b[j]);
      const Vector<Number> apart = difference(a[i], b[j]);
      const Number aa = dot(along_a, along_a), ab = dot(along_a, along_b);
      const Number bb = dot(along_b, along_b), determinant = aa * bb - ab * ab;
      if (determinant <= 0) continue;
      const Number of_a = dot(along_a, apart), of_b = dot(along_b, apart);
      const Number s = (ab * of_b - bb * of_a) / determinant;
      const Number t = (aa * of_b - ab * of_a) / determinant;
      if (s < 0 || s > 1 || t < 0 || t > 1) continue;
      take(squared_distance(plus(a[i], s, along_a), plus(b[j], t, along_b)));
    }
  }
  return least;
}

// Distance of two placed triangles: exactly zero if and only if they touch, else to many digits.
inline double exact_gap(const std::array<Eigen::Vector3d, 3>& a, const Pose& world_from_a,
                        const std::array<Eigen::Vector3d, 3>& b, const Pose& world_from_b) {
  const Real square =
      squared_distance(placed<Real>(world_from_a, a), placed<Real>(world_from_b, b));
  if (square > Real(1e-60)) return sqrt(square).convert_to<double>();
  const Rational exact_square =
      squared_distance(placed<Rational>(world_from_a, a), placed<Rational>(world_from_b, b));
  return exact_square > 0 ? std::max(1e-300, std::sqrt(exact_square.convert_to<double>())) : 0.0;
}

inline double exact_gap(const TriangleMesh& a, const Pose& world_from_a, const TriangleMesh& b,
                        const Pose& world_from_b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& of_a : a.triangles) {
    for (const Eigen::Vector3i& of_b : b.triangles) {
      least = std::min(
          least, exact_gap(corners_of(a, of_a), world_from_a, corners_of(b, of_b), world_from_b));
    }
  }
  return least;
}

inline Real exact_triangle_distance(const Eigen::Vector3d& p,
                                    const std::array<Eigen::Vector3d, 3>& triangle) {
  return sqrt(squared_distance_to_triangle(exact<Real>(p), placed<Real>(Pose(), triangle)));
}

// To the box of a triangle, in double: right but for some 1e-16 of itself.
inline double rough_box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                 const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Vector3d high = a.cwiseMax(b).cwiseMax(c);
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).stableNorm();
}

inline Real exact_mesh_distance(const Eigen::Vector3d& p, const TriangleMesh& mesh) {
  // Triangles in the order of their boxes' distances, up to those that are clearly further.
  std::vector<std::pair<double, std::size_t>> boxes;
  const auto vertex = [&](std::size_t i, int k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    boxes.emplace_back(rough_box_distance(p, vertex(i, 0), vertex(i, 1), vertex(i, 2)), i);
  }
  std::ranges::sort(boxes);
  Real best = -1;
  for (const auto& [box_distance, i] : boxes) {
    if (best >= 0 && box_distance * (1.0 - 1e-12) > best) break;
    const Real d = exact_triangle_distance(p, {vertex(i, 0), vertex(i, 1), vertex(i, 2)});
    if (best < 0 || d < best) best = d;
  }
  return best;
}

// What a pose takes to `p`.
inline Vector<Real> brought_back(const Pose& pose, const Vector<Real>& p) {
  const Vector<Real> origin = transform(pose, Vector<Real>{0, 0, 0});
  const Vector<Real> way = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
  Vector<Real> result;
  for (std::size_t i = 0; i < 3; ++i) {
    Vector<Real> axis = {0, 0, 0};
    axis[i] = 1;
    const Vector<Real> image = transform(pose, axis);
    result[i] = (image[0] - origin[0]) * way[0] + (image[1] - origin[1]) * way[1] +
                (image[2] - origin[2]) * way[2];
  }
  return result;
}

// Negative inside: minus the distance to the surface.
class ExactSignedDistance {
 public:
  explicit ExactSignedDistance(const Vector<Real>& p) : p_(p) {}

  Real operator()(const Box& box) const {
    Real outside = 0;
    Real nearest_face = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const Real depth = Real(box.size[static_cast<Eigen::Index>(i)]) / 2 - abs(p_[i]);
      if (depth < 0) outside += depth * depth;
      nearest_face = std::min(nearest_face, depth);
    }
    return outside > 0 ? Real(sqrt(outside)) : -nearest_face;
  }
  Real operator()(const SolidSphere& sphere) const {
    return sqrt(p_[0] * p_[0] + p_[1] * p_[1] + p_[2] * p_[2]) - sphere.radius;
  }
  Real operator()(const Cylinder& cylinder) const {
    const Real side = cylinder.radius - sqrt(p_[0] * p_[0] + p_[1] * p_[1]);
    const Real end = Real(cylinder.length) / 2 - abs(p_[2]);
    if (side >= 0 && end >= 0) return -std::min(side, end);
    if (side >= 0) return -end;
    if (end >= 0) return -side;
    return sqrt(side * side + end * end);
  }
  Real operator()(const Capsule& capsule) const {
    const Real beyond = abs(p_[2]) - Real(capsule.length) / 2;
    const Real along = beyond > 0 ? beyond : Real(0);
    return sqrt(p_[0] * p_[0] + p_[1] * p_[1] + along * along) - capsule.radius;
  }
  Real operator()(const HalfSpace&) const { return p_[2]; }

 private:
  Vector<Real> p_;
};

// From a placed sphere to a placed solid: its distance where above zero, otherwise how far it has
// to move to part from it, with the sign changed.
inline Real exact_gap(const Sphere& sphere, const Pose& world_from_sphere, const Primitive& solid,
                      const Pose& world_from_solid) {
  const Vector<Real> center =
      brought_back(world_from_solid, transform(world_from_sphere, exact<Real>(sphere.center)));
  return std::visit(ExactSignedDistance(center), solid) - sphere.radius;
}

}  // namespace spherule::test
