// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/exact/spheres.h"

#include "geometry/sphere.h"
#include "tests/support/effort.h"
#include "tests/support/exact/trees.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule::test {
namespace {

// `value` moved by up to ten units in the last place either way.
double nudged(double value, Random& random) {
  const int steps = static_cast<int>(random.index(21)) - 10;
  for (int i = 0; i < std::abs(steps); ++i) value = steps > 0 ? next_up(value) : next_down(value);
  return std::max(0.0, value);
}

Sphere random_sphere(Random& random) {
  const double scale = std::pow(10.0, random.between(-6.0, 6.0));
  return {scale * random.point(1.0), scale * random.unit()};
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
    const Sphere a = {random.point(1.0), random.unit()};
    const Sphere b = {random.point(1.0), random.unit()};
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
    const Eigen::Vector3d a = scale * random.point(1.0);
    const Eigen::Vector3d b =
        i % 2 == 0 ? random.point(scale) : Eigen::Vector3d(next_up(a.x()), a.y(), a.z());
    const Rational exact = exact_squared_distance(a, b);
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

using Eigen::Vector3d;

double largest_coordinate(std::span<const Sphere> spheres) {
  double largest = 0.0;
  for (const Sphere& sphere : spheres) {
    largest = std::max({largest, sphere.center.cwiseAbs().maxCoeff(), sphere.radius});
  }
  return largest;
}

// Encloses all in exact arithmetic and by our own predicate, and is the smallest up to rounding:
// `relative` of its radius plus a few units in the last place of the largest coordinate (the centre
// must be rounded to doubles). kUnderflow is the padding that stands for squares that underflow.
void expect_smallest(const Sphere& result, std::span<const Sphere> spheres,
                     double relative = 1e-14) {
  for (const Sphere& sphere : spheres) {
    ASSERT_TRUE(encloses_exactly(result, sphere));
    ASSERT_TRUE(certainly_encloses(result, sphere));
  }
  const long double slack = relative * static_cast<long double>(result.radius) +
                            16.0L * kUnitRoundoff * largest_coordinate(spheres) + 2.0L * kUnderflow;
  EXPECT_LE(static_cast<long double>(result.radius),
            smallest_radius_lower_bound(result, spheres) + slack);
}

TEST(EnclosingSphere, SmallSetsOfEveryFamilyAreEnclosedTightly) {
  for (std::size_t count = 1; count <= 20; ++count) {
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(effort(25, 4)); ++seed) {
      for (const Family& family : sphere_families(count, seed)) {
        SCOPED_TRACE(family.name + ", " + std::to_string(count) + " spheres, seed " +
                     std::to_string(seed));
        expect_smallest(enclosing_sphere(family.spheres), family.spheres);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(EnclosingSphere, LargeSetsOfEveryFamilyAreEnclosedTightly) {
  for (const Family& family : sphere_families(static_cast<std::size_t>(effort(3000, 600)), 7)) {
    SCOPED_TRACE(family.name);
    expect_smallest(enclosing_sphere(family.spheres), family.spheres);
  }
}

// Nearly nested spheres are the ill-conditioned case: the unit sphere and others that stick out of
// it by a hair.
TEST(EnclosingSphere, NearlyNestedSpheres) {
  Random random(11);
  for (int i = 0; i < 3000; ++i) {
    std::vector<Sphere> spheres = {{Vector3d::Zero(), 1.0}};
    const std::size_t count = 1 + random.index(5);
    for (std::size_t k = 0; k < count; ++k) {
      const double radius = random.unit();
      const double excess = std::pow(10.0, random.between(-16.0, -1.0));
      spheres.push_back({(1.0 - radius + excess) * random.direction(), radius});
    }
    SCOPED_TRACE(i);
    expect_smallest(enclosing_sphere(spheres), spheres);
    if (HasFailure()) return;
  }
}

// Textbook cases with a known answer.
TEST(EnclosingSphere, KnownSpheres) {
  const auto expect_near = [](const Sphere& s, const Vector3d& center, double radius) {
    EXPECT_LT((s.center - center).norm(), 1e-14);
    EXPECT_NEAR(s.radius, radius, 1e-14);
  };
  expect_near(enclosing_sphere(std::vector<Vector3d>{{1, 2, 3}}), {1, 2, 3}, 0.0);
  expect_near(enclosing_sphere(std::vector<Vector3d>{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}), {0, 0, 0},
              1.0);
  expect_near(
      enclosing_sphere(std::vector<Vector3d>{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}),
      {0, 0, 0}, std::sqrt(3.0));
  expect_near(enclosing_sphere(std::vector<Sphere>{{{0, 0, 0}, 1.0}, {{3, 0, 0}, 2.0}}), {2, 0, 0},
              3.0);
  expect_near(enclosing_sphere(std::vector<Sphere>{{{0, 0, 0}, 4.0}, {{1, 0, 0}, 2.0}}), {0, 0, 0},
              4.0);
  // The case in which Welzl's algorithm, which is right for points, fails for spheres: the answer
  // is determined by other spheres than those of a smaller set's boundary.
  expect_near(enclosing_sphere(std::vector<Sphere>{
                  {{-2, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}, {{0, 0, 0}, 2.5}, {{0, 0.25, 0}, 2.5}}),
              {0, 0, 0}, 3.0);
}

TEST(EnclosingSphere, DoesNotDependOnPointsBeingGivenAsSpheres) {
  Random random(5);
  std::vector<Vector3d> points;
  std::vector<Sphere> spheres;
  for (int i = 0; i < 500; ++i) {
    points.push_back(random.point(3.0));
    spheres.push_back({points.back(), 0.0});
  }
  EXPECT_EQ(enclosing_sphere(points), enclosing_sphere(spheres));
}

// The oracle itself must be able to say no: a sphere a little too large is not accepted.
TEST(EnclosingSphere, TheOracleSeesSpheresThatAreTooLarge) {
  Random random(3);
  for (const Family& family : sphere_families(12, 3)) {
    if (family.name == "squares underflow") continue;  // the padding is larger than the spheres
    Sphere sphere = enclosing_sphere(family.spheres);
    sphere.radius *= 1.0 + 1e-5;
    EXPECT_LT(smallest_radius_lower_bound(sphere, family.spheres), sphere.radius * (1.0 - 1e-6L))
        << family.name;
  }
}

}  // namespace
}  // namespace spherule::test
