// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Distances of points, segments and triangles, in whatever numbers are exact enough: rational ones
// for the question whether two triangles touch. Nothing is assumed of the triangles.

#include "tests/collide/exact_scene.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace spherule::test {

template <class Number>
using ExactTriangle = std::array<Vector<Number>, 3>;

template <class Number>
Vector<Number> difference(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Vector<Number> plus(const Vector<Number>& a, const Number& factor, const Vector<Number>& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

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

}  // namespace spherule::test
