// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres in rational numbers, and in floating-point numbers of 100 digits where a root is needed:
// an oracle that shares no code with the library.

#include "geometry/sphere.h"
#include "tests/support/exact/poses.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;
using Real = boost::multiprecision::cpp_bin_float_100;

inline Rational exact_squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return squared_distance(exact<Rational>(a), exact<Rational>(b));
}
inline Real exact_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return sqrt(squared_distance(exact<Real>(a), exact<Real>(b)));
}

// Nearly all comparisons are clear in long double, whose differences, squares and sums of squares
// of doubles are right but for 8 x 2^-64 of themselves.
inline std::optional<bool> is_clearly_at_most(long double x, long double y) {
  constexpr long double kSlack = 0x1p-58L;
  if (x * (1.0L + kSlack) <= y * (1.0L - kSlack)) return true;
  if (x * (1.0L - kSlack) > y * (1.0L + kSlack)) return false;
  return {};
}

inline long double rough_squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.cast<long double>() - b.cast<long double>()).squaredNorm();
}

// |c_o - c_i| + r_i <= r_o, without the root.
inline bool encloses_exactly(const Sphere& outer, const Sphere& inner) {
  const long double rough_room = static_cast<long double>(outer.radius) - inner.radius;
  if (rough_room < 0.0L) return false;  // the sign is right
  const std::optional<bool> clear = is_clearly_at_most(
      rough_squared_distance(outer.center, inner.center), rough_room * rough_room);
  if (clear) return *clear;
  const Rational room = Rational(outer.radius) - Rational(inner.radius);
  return room >= 0 && exact_squared_distance(outer.center, inner.center) <= room * room;
}

// The closed spheres share a point: |c_a - c_b| <= r_a + r_b.
inline bool overlap_exactly(const Sphere& a, const Sphere& b) {
  const long double rough_sum = static_cast<long double>(a.radius) + b.radius;
  const std::optional<bool> clear =
      is_clearly_at_most(rough_squared_distance(a.center, b.center), rough_sum * rough_sum);
  if (clear) return *clear;
  const Rational sum = Rational(a.radius) + Rational(b.radius);
  return exact_squared_distance(a.center, b.center) <= sum * sum;
}

// Two placed spheres.
struct PlacedSphereSets {
  Sphere a, b;
  Pose world_from_a, world_from_b;

  template <class Number>
  Number squared_center_distance() const {
    return squared_distance(transform(world_from_a, exact<Number>(a.center)),
                            transform(world_from_b, exact<Number>(b.center)));
  }

  Real center_distance() const { return sqrt(squared_center_distance<Real>()); }

  // Negative where the spheres overlap.
  Real gap() const { return center_distance() - a.radius - b.radius; }

  // Whether the closed spheres share a point, in exact arithmetic.
  bool overlap() const {
    const Rational sum = Rational(a.radius) + Rational(b.radius);
    return squared_center_distance<Rational>() <= sum * sum;
  }
};

// Spheres under exactly the motion p -> R(q / |q|) p + t of a pose.
struct PlacedSet {
  std::span<const Sphere> spheres;
  Pose world_from_set;
};

// The least gap of two spheres, one of each set.
inline Real exact_gap(const PlacedSet& a, const PlacedSet& b) {
  Real least = std::numeric_limits<double>::infinity();
  for (const Sphere& p : a.spheres) {
    for (const Sphere& q : b.spheres) {
      const Real gap = PlacedSphereSets{p, q, a.world_from_set, b.world_from_set}.gap();
      if (gap < least) least = gap;
    }
  }
  return least;
}

// Whether two spheres, one of each set, touch in exact arithmetic: by long double where that is
// certain. Let u be its unit roundoff and n = q.q. An entry of n R is a sum of products whose
// magnitudes sum up to at most n, within 4 u n. With the matrix's error, its products and sums, the
// division by n and the sum, the image of p errs by less than 28 u |p| + 2 u |t|. The difference of
// two images, its length and the subtraction of the radii add less than 8 u times what they are
// made from. So 64 u (|p| + |t| + r), summed over both spheres, bounds the error of a gap.
inline bool touch_exactly(const PlacedSet& a, const PlacedSet& b) {
  using Long = long double;
  struct Placed {
    Vector<Long> center;
    Long error;
  };
  const auto placed = [](const PlacedSet& set) {
    std::vector<Placed> all;
    for (const auto& [center, radius] : set.spheres) {
      const double extent =
          center.lpNorm<1>() + set.world_from_set.translation().lpNorm<1>() + radius;
      all.push_back({transform(set.world_from_set, exact<Long>(center)),
                     32 * std::numeric_limits<Long>::epsilon() * extent * (1 + 1e-9)});
    }
    return all;
  };
  const std::vector<Placed> of_a = placed(a), of_b = placed(b);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    for (std::size_t j = 0; j < of_b.size(); ++j) {
      const Sphere &p = a.spheres[i], &q = b.spheres[j];
      const Long gap = std::sqrt(squared_distance(of_a[i].center, of_b[j].center)) -
                       (static_cast<Long>(p.radius) + q.radius);
      const Long error = of_a[i].error + of_b[j].error;
      if (gap < -error) return true;
      if (gap > error) continue;
      if (PlacedSphereSets{p, q, a.world_from_set, b.world_from_set}.overlap()) return true;
    }
  }
  return false;
}

}  // namespace spherule::test
