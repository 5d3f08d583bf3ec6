// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Outward rounding: sums, products, norms and distances, rounded to a proved side; G3 and all other
// proofs rest on it. The bounds of longer computations stand with these (pose.h, point_triangle.h,
// motion.cpp, ...).
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
//
// Flush to zero: a program that is linked with -ffast-math or -Ofast may start with subnormal
// numbers read and written as zero, in all its code. Each operation may then lose 2^-1022 more.
// Where a distance is zero or at least 2^-460 that stays far below the factor 1 +- 8 u: the three
// differences lose 2^-1022 each, a radicand of at least 2^-920 loses 3 * 2^-1022. Sums and
// differences (add_up and so on) are exact before they are rounded unless they are subnormal.
//
// Fast-math: the preprocessor refuses a source that is compiled with it (below), since there a
// compiler takes NaN for impossible and changes the order of operations.
//
// @code{.cpp}
// #include <spherule/base/rounding.h>
// #include <cassert>
//
// assert(spherule::add_up(1.0, 0x1p-60) > 1.0);
// assert(spherule::norm_lower({3, 4, 0}) <= 5.0 && 5.0 <= spherule::norm_upper({3, 4, 0}));
// @endcode

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "spherule: -ffast-math, -Ofast and parts of them invalidate the proved rounding bounds"
#endif

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
// add_up() that is exact where one of the two is zero: for lengths that users see, as a padding.
inline double sum_up(double a, double b) {
  return a == 0.0 || b == 0.0 ? a + b : add_up(a, b);
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

// Throws Error unless this thread rounds to nearest, as every proved bound presumes. build_tree(),
// refit(), check(), load_tree(), place_external_spheres(), cover(), repair(), certify(),
// prove_link_pairs(), prove_attached_pairs() and the constructors of PairCache and
// RobotChecker::Scratch call it, and so does what calls these; single queries, enclosing_sphere()
// and readers of meshes do not. If the mode is changed after that nothing is promised; in tests no
// contact was missed. Determined by sums, as std::fegetround() does not see every floating-point
// unit of a processor.
void require_rounding_to_nearest();

}  // namespace spherule
