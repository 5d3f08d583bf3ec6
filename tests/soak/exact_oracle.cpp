// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/exact_oracle.h"

#include "tests/support/exact/poses.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

// The error of a gap. Let u be the unit roundoff of the number type and n = q.q. An entry of n R is
// a sum of products whose magnitudes sum up to at most n: four squares and three sums, within 4 u
// n. With the matrix's error, its products and sums, the division by n (4 u) and its own rounding,
// a component of the image of p errs by less than (7 + 3 + 4 + 1) u |p|, and by u (|p| + |t|) more
// for the sum: less than 28 u |p| + 2 u |t| as a vector. The difference of two images, its length
// and the subtraction of the radii add less than 8 u times what they are made from, which is at
// most the sum of all |p|, |t| and radii. So 64 u (|p| + |t| + r), summed over both spheres, bounds
// the error of a gap, and of the limit that a distance is held against; a clearance adds 16 u of
// it. (Powers of two scale the quaternions without error; their squares do not underflow.)

namespace spherule::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;

template <class Number>
constexpr Number kPlaceError = 64 * (std::numeric_limits<Number>::epsilon() / 2);
template <class Number>
constexpr Number kClearanceError = 16 * (std::numeric_limits<Number>::epsilon() / 2);

template <class Number>
Number squared_distance(const Pose& world_from_a, const Eigen::Vector3d& p,
                        const Pose& world_from_b, const Eigen::Vector3d& q) {
  return test::squared_distance(transform(world_from_a, exact<Number>(p)),
                                transform(world_from_b, exact<Number>(q)));
}

// |p| + |t| + r, a little larger.
double extent(const Sphere& sphere, const Pose& pose) {
  return (sphere.center.lpNorm<1>() + pose.translation().lpNorm<1>() + sphere.radius) * (1 + 1e-9);
}

GapBounds pair_gap(const Sphere& p, const Pose& world_from_a, const Sphere& q,
                   const Pose& world_from_b) {
  const long double way =
      std::sqrt(squared_distance<long double>(world_from_a, p.center, world_from_b, q.center));
  const long double gap = way - (static_cast<long double>(p.radius) + q.radius);
  const long double error =
      kPlaceError<long double> *
      (static_cast<long double>(extent(p, world_from_a)) + extent(q, world_from_b));
  return {gap - error, gap + error};
}

bool pair_within(const Sphere& p, const Pose& world_from_a, const Sphere& q,
                 const Pose& world_from_b, double clearance) {
  const Rational limit = Rational(p.radius) + Rational(q.radius) + Rational(clearance);
  return squared_distance<Rational>(world_from_a, p.center, world_from_b, q.center) <=
         limit * limit;
}

}  // namespace

void ExactOracle::Spheres::place(const PlacedSet& set) {
  const std::size_t count = set.spheres.size();
  for (auto* numbers : {&x, &y, &z, &radius, &error}) numbers->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<double> center =
        transform(set.world_from_set, exact<double>(set.spheres[i].center));
    x[i] = center[0];
    y[i] = center[1];
    z[i] = center[2];
    radius[i] = set.spheres[i].radius;
    error[i] = kPlaceError<double> * extent(set.spheres[i], set.world_from_set);
  }
}

bool ExactOracle::within(const PlacedSet& a, const PlacedSet& b, double clearance) {
  a_.place(a);
  b_.place(b);
  std::vector<std::array<std::size_t, 2>> uncertain;
  for (std::size_t i = 0; i < a_.x.size(); ++i) {
    for (std::size_t j = 0; j < b_.x.size(); ++j) {
      const double x = a_.x[i] - b_.x[j], y = a_.y[i] - b_.y[j], z = a_.z[i] - b_.z[j];
      const double squared = x * x + y * y + z * z;
      const double limit = a_.radius[i] + b_.radius[j] + clearance;
      const double error = a_.error[i] + b_.error[j] + kClearanceError<double> * clearance;
      const double far = limit + error, near = limit - error;
      if (squared > far * far) continue;
      if (near > 0.0 && squared < near * near) return true;
      uncertain.push_back({i, j});
    }
  }
  std::vector<std::array<std::size_t, 2>> open;
  for (const auto& [i, j] : uncertain) {
    const GapBounds bounds =
        pair_gap(a.spheres[i], a.world_from_set, b.spheres[j], b.world_from_set);
    const long double error = kClearanceError<long double> * clearance;
    if (bounds.upper < clearance - error) return true;
    if (bounds.lower <= clearance + error) open.push_back({i, j});
  }
  rational_pairs_ += open.size();
  return std::any_of(open.begin(), open.end(), [&](const auto& pair) {
    return pair_within(a.spheres[pair[0]], a.world_from_set, b.spheres[pair[1]], b.world_from_set,
                       clearance);
  });
}

GapBounds ExactOracle::gap(const PlacedSet& a, const PlacedSet& b) {
  a_.place(a);
  b_.place(b);
  // Calls `use` with the bounds in double of every pair's gap.
  const auto for_each_pair = [&](auto use) {
    for (std::size_t i = 0; i < a_.x.size(); ++i) {
      for (std::size_t j = 0; j < b_.x.size(); ++j) {
        const double x = a_.x[i] - b_.x[j], y = a_.y[i] - b_.y[j], z = a_.z[i] - b_.z[j];
        const double gap = std::sqrt(x * x + y * y + z * z) - (a_.radius[i] + b_.radius[j]);
        use(i, j, gap, a_.error[i] + b_.error[j]);
      }
    }
  };
  double least = std::numeric_limits<double>::infinity();
  for_each_pair([&](std::size_t, std::size_t, double gap, double error) {
    least = std::min(least, gap + error);
  });
  GapBounds bounds{std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  for_each_pair([&](std::size_t i, std::size_t j, double gap, double error) {
    if (gap - error > least) return;
    const GapBounds pair = pair_gap(a.spheres[i], a.world_from_set, b.spheres[j], b.world_from_set);
    bounds.lower = std::min(bounds.lower, pair.lower);
    bounds.upper = std::min(bounds.upper, pair.upper);
  });
  return bounds;
}

}  // namespace spherule::test
