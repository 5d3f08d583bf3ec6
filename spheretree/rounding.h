// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Outward rounding: the one place where the rounding errors of the whole library are bounded.
//
// Model: IEEE double, round to nearest, u = 2^-53. Every bound below holds for coordinates of
// magnitude at most kMaxCoordinate and with or without contraction to fused multiply-add, because
// fusing only removes roundings.
//
// Norm of an exact vector v: the squares are each rounded once, their sum twice, so the radicand
// has a relative error below (1+u)^3 - 1, its root half of that plus one rounding: 2.5 u. Distance
// of two exact points: each difference is rounded once more, which adds 1 u: 3.5 u. All terms are
// positive, so nothing cancels. Squares below 2^-1022 may lose up to 2^-1075 each; the root of
// three of those is below 2^-536. Hence |computed - exact| <= 3.5 u exact + 2^-536, up to terms of
// order u^2, and the factor 1 +- 8 u with the absolute term kUnderflow covers both with room to
// spare (the multiplication and the addition that apply them cost 2 u).

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule {

inline constexpr double kUnitRoundoff = 0x1p-53;

// Numbers beyond this are refused at the boundary (meshes, spheres, poses). Squares of differences
// stay below 1e32, far from overflow.
inline constexpr double kMaxCoordinate = 1e15;

// Covers the loss of squares that underflow (see above).
inline constexpr double kUnderflow = 0x1p-530;

inline constexpr double kRelativeUp = 1.0 + 8.0 * kUnitRoundoff;
inline constexpr double kRelativeDown = 1.0 - 8.0 * kUnitRoundoff;

// The neighbouring double above, and below.
inline double next_up(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}
inline double next_down(double x) {
  return std::nextafter(x, -std::numeric_limits<double>::infinity());
}

// One operation, rounded so that the result is not below (up) or above (down) the exact value.
inline double add_up(double a, double b) {
  return next_up(a + b);
}
inline double add_down(double a, double b) {
  return next_down(a + b);
}
inline double sub_up(double a, double b) {
  return next_up(a - b);
}
inline double sub_down(double a, double b) {
  return next_down(a - b);
}
inline double mul_up(double a, double b) {
  return next_up(a * b);
}

// Bounds of the Euclidean norm of `v`, whose components are taken as exact.
inline double norm_upper(const Eigen::Vector3d& v) {
  return v.norm() * kRelativeUp + kUnderflow;
}
inline double norm_lower(const Eigen::Vector3d& v) {
  return std::max(0.0, v.norm() * kRelativeDown - kUnderflow);
}

// Bounds of the Euclidean distance of two points whose coordinates are taken as exact.
inline double distance_upper(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return norm_upper(a - b);
}
inline double distance_lower(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return norm_lower(a - b);
}

// Whether numbers are finite and within kMaxCoordinate.
inline bool is_usable_coordinate(double x) {
  return std::abs(x) <= kMaxCoordinate;
}
inline bool is_usable_point(const Eigen::Vector3d& p) {
  return is_usable_coordinate(p.x()) && is_usable_coordinate(p.y()) && is_usable_coordinate(p.z());
}

}  // namespace spherule
