// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/sphere.h"

#include "tests/spheretree/exact.h"
#include "tests/spheretree/spheres.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spherule::test::sphere_test {
namespace {

// `value` moved by up to ten units in the last place either way.
double nudged(double value, Random& random) {
  const int steps = static_cast<int>(random.below(21)) - 10;
  for (int i = 0; i < std::abs(steps); ++i) value = steps > 0 ? next_up(value) : next_down(value);
  return std::max(0.0, value);
}

Sphere random_sphere(Random& random) {
  const double scale = std::pow(10.0, random.between(-6.0, 6.0));
  return {scale * random.in_cube(1.0), scale * random.unit()};
}

// Counts how predicate and truth agree near the limit.
struct Tally {
  int both = 0;
  int neither = 0;
  int padded = 0;  // they differ, to the safe side
};

constexpr int kCases = effort(100000, 20000);

TEST(Sphere, CertainlyEnclosesIsNeverWrong) {
  Random random(1);
  Tally tally;
  for (int i = 0; i < kCases; ++i) {
    const Sphere inner = random_sphere(random);
    Sphere outer = random_sphere(random);
    outer.radius = nudged((outer.center - inner.center).norm() + inner.radius, random);
    const bool certain = certainly_encloses(outer, inner);
    const bool truth = encloses_exactly(outer, inner);
    ASSERT_TRUE(!certain || truth);
    ASSERT_EQ(certain, certainly_contains(outer, inner.center, inner.radius));
    ++(certain ? tally.both : truth ? tally.padded : tally.neither);
  }
  EXPECT_GT(tally.both, kCases / 10);
  EXPECT_GT(tally.neither, kCases / 10);
  EXPECT_GT(tally.padded, kCases / 100);
}

TEST(Sphere, PossiblyOverlapIsNeverWrong) {
  Random random(2);
  Tally tally;
  for (int i = 0; i < kCases; ++i) {
    const Sphere a = random_sphere(random);
    Sphere b = random_sphere(random);
    b.radius = nudged((a.center - b.center).norm() - a.radius, random);
    const bool possible = possibly_overlap(a, b);
    const bool truth = overlap_exactly(a, b);
    ASSERT_TRUE(possible || !truth);
    ++(truth ? tally.both : possible ? tally.padded : tally.neither);
  }
  EXPECT_GT(tally.both, kCases / 10);
  EXPECT_GT(tally.neither, kCases / 20);
  EXPECT_GT(tally.padded, kCases / 100);
}

// The textbook merge of two spheres is what this library must not do: it often loses an input.
TEST(Sphere, TheExactOracleRefusesTheTextbookMerge) {
  Random random(3);
  int lost = 0;
  for (int i = 0; i < 1000; ++i) {
    const Sphere a = {random.in_cube(1.0), random.unit()};
    const Sphere b = {random.in_cube(1.0), random.unit()};
    const double distance = (b.center - a.center).norm();
    const double radius = 0.5 * (distance + a.radius + b.radius);
    const Sphere merged = {a.center + (b.center - a.center) * ((radius - a.radius) / distance),
                           radius};
    if (!encloses_exactly(merged, a) || !encloses_exactly(merged, b)) ++lost;
  }
  EXPECT_GT(lost, 300);
}

TEST(Sphere, DistanceBoundsHoldAtAllScales) {
  Random random(4);
  for (int i = 0; i < effort(20000, 4000); ++i) {
    const double scale = std::pow(10.0, random.between(-320.0, 15.0));
    const Eigen::Vector3d a = scale * random.in_cube(1.0);
    const Eigen::Vector3d b =
        i % 2 == 0 ? random.in_cube(scale) : Eigen::Vector3d(next_up(a.x()), a.y(), a.z());
    const Rational exact = squared_distance(a, b);
    const Rational upper(distance_upper(a, b));
    const Rational lower(distance_lower(a, b));
    ASSERT_GE(upper * upper, exact);
    ASSERT_LE(lower * lower, exact);
  }
}

TEST(Sphere, Usable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(is_usable(Sphere{}));
  EXPECT_TRUE(is_usable(Sphere{{1e15, -1e15, 0}, 1e15}));
  for (const double bad : {nan, infinity, -infinity, 1.1e15, -1.1e15}) {
    for (int axis = 0; axis < 3; ++axis) {
      Sphere sphere;
      sphere.center[axis] = bad;
      EXPECT_FALSE(is_usable(sphere));
    }
    EXPECT_FALSE(is_usable(Sphere{{0, 0, 0}, bad}));
  }
  EXPECT_FALSE(is_usable(Sphere{{0, 0, 0}, -1e-300}));
}

}  // namespace
}  // namespace spherule::test::sphere_test
