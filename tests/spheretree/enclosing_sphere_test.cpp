// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/enclosing_sphere.h"

#include "tests/spheretree/enclosing_oracle.h"
#include "tests/spheretree/exact.h"
#include "tests/spheretree/spheres.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spherule::test {
namespace {

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
    const std::size_t count = 1 + random.below(5);
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
    points.push_back(random.in_cube(3.0));
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
