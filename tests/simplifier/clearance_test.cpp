// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/clearance.h"

#include "simplifier/solid/sphere_hierarchy.h"
#include "tests/mesh/distance_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Clearance;
using internal::ClearanceAt;
using internal::NearestSphere;
using internal::SphereHierarchy;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of all sizes; those of an odd `kind` line a plane, with radii up to it, as external spheres do.
std::vector<Sphere> random_spheres(Random& random, std::size_t count, int kind, double scale,
                                   const Vector3d& shift) {
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d c = random.in_box(box);
    const double radius = kind % 2 == 1 ? c.z() : random.between(0.0, kind % 3 == 0 ? 0.1 : 1.5);
    spheres.push_back({scale * c + shift, scale * radius});
  }
  return spheres;
}

Digits50 exact_gap(const Vector3d& p, std::span<const Sphere> spheres) {
  Digits50 gap = spheres.empty() ? Digits50(1e300) : Digits50(-1e300);
  bool first = true;
  for (const Sphere& s : spheres) {
    const Digits50 g = exact_distance(p, s.center) - s.radius;
    if (first || g < gap) gap = g;
    first = false;
  }
  return gap;
}

Digits50 exact_clearance(const Vector3d& p, const ExternalSpheres& external) {
  Digits50 least = exact_gap(p, external.spheres);
  for (int axis = 0; axis < 3; ++axis) {
    least = std::min({least, Digits50(p[axis]) - external.box.min()[axis],
                      Digits50(external.box.max()[axis]) - p[axis]});
  }
  return least;
}

ExternalSpheres random_external(Random& random, int i) {
  ExternalSpheres external;
  external.box = Eigen::AlignedBox3d(Vector3d::Zero(), Vector3d::Constant(4));
  external.spheres =
      random_spheres(random, i % 7 == 0 ? 0 : 1 + random.index(200), i, 1.0, Vector3d::Zero());
  return external;
}

// Spheres that touch a rod of radius 1 about the z axis from outside.
std::vector<Sphere> spheres_about_rod(Random& random) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 400; ++i) {
    const double angle = random.between(0.0, 6.2831853);
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d contact = out + Vector3d(0, 0, random.between(0.0, 4.0));
    const double radius = random.between(1.0, i % 5 == 0 ? 20.0 : 1.2);
    spheres.push_back({contact + radius * out, radius});
  }
  return spheres;
}

const Eigen::AlignedBox3d kAround(Vector3d::Constant(-1), Vector3d::Constant(5));

TEST(SphereHierarchy, BoundsContainTheExactGapAtEveryScaleAndPlace) {
  Random random(41);
  for (int i = 0; i < effort(60, 12); ++i) {
    const double scale = i % 4 == 0 ? 1e-6 : i % 4 == 1 ? 1e6 : 1.0;
    const Vector3d shift = i % 4 == 2 ? Vector3d(1e6, 1e6, -1e6) : Vector3d(0, 0, 0);
    const std::vector<Sphere> spheres =
        random_spheres(random, 1 + random.index(150), i, scale, shift);
    const SphereHierarchy hierarchy(spheres);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p =
          k == 0 ? spheres.front().center : Vector3d(scale * random.in_box(kAround) + shift);
      const Digits50 exact = exact_gap(p, spheres);
      const NearestSphere found = hierarchy.nearest(p);
      ASSERT_LE(Digits50(found.lower), exact);
      ASSERT_GE(Digits50(found.upper), exact);
      ASSERT_LE(found.upper - found.lower, 1e-13 * (10.0 * scale + shift.norm()));
      const Sphere& sphere = spheres.at(static_cast<std::size_t>(found.index));
      ASSERT_LE(exact_distance(p, sphere.center) - sphere.radius, Digits50(found.upper));
    }
  }
}

TEST(SphereHierarchy, LimitAndToleranceLoosenTheBoundsAsStated) {
  Random random(42);
  int within = 0;
  int beyond = 0;
  for (int i = 0; i < effort(60, 12); ++i) {
    const std::vector<Sphere> spheres = random_spheres(random, 120, i, 1.0, Vector3d::Zero());
    const SphereHierarchy hierarchy(spheres);
    for (int k = 0; k < 30; ++k) {
      const Vector3d p = random.in_box(kAround);
      const Digits50 exact = exact_gap(p, spheres);
      const double limit = random.between(-1.0, 1.0);
      const NearestSphere limited = hierarchy.nearest(p, limit);
      if (exact >= limit) {
        ++beyond;
        ASSERT_EQ(limited.index, -1);
        ASSERT_LE(limited.lower, limit);
        ASSERT_GE(limited.lower, limit - 1e-12);
        ASSERT_EQ(limited.upper, limit);
      } else if (exact < limit - 1e-12) {
        ++within;
        ASSERT_GE(limited.index, 0);
        ASSERT_LE(Digits50(limited.lower), exact);
        ASSERT_GE(Digits50(limited.upper), exact);
      }
      const double tolerance = random.between(0.0, 0.3);
      const NearestSphere loose = hierarchy.nearest(p, kInfinity, tolerance);
      ASSERT_LE(Digits50(loose.lower), exact);
      ASSERT_GE(Digits50(loose.upper), exact);
      ASSERT_LE(loose.upper - loose.lower, tolerance + 1e-12);
    }
  }
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 50);
}

TEST(SphereHierarchy, BoundsHoldWhereSpheresAreTied) {
  Random random(43);
  for (int i = 0; i < effort(30, 6); ++i) {
    const std::vector<Sphere> spheres = spheres_about_rod(random);
    const SphereHierarchy hierarchy(spheres);
    for (int k = 0; k < 40; ++k) {
      Vector3d p = random.in_box(kAround);
      if (k % 2 == 0) p.head<2>() *= 1e-3;  // near the axis, where all spheres are nearly tied
      const Digits50 exact = exact_gap(p, spheres);
      const double tolerance = k % 4 < 2 ? 0.0 : 0.01;
      const NearestSphere found = hierarchy.nearest(p, kInfinity, tolerance);
      ASSERT_LE(Digits50(found.lower), exact);
      ASSERT_GE(Digits50(found.upper), exact);
      ASSERT_LE(found.upper - found.lower, tolerance + 1e-12);
    }
  }
}

TEST(SphereHierarchy, AnEmptySetIsInfinitelyFar) {
  const SphereHierarchy hierarchy;
  EXPECT_TRUE(hierarchy.empty());
  EXPECT_EQ(hierarchy.nearest({0, 0, 0}).lower, kInfinity);
  EXPECT_EQ(hierarchy.nearest({0, 0, 0}).index, -1);
}

TEST(Clearance, BoundsContainTheExactValue) {
  Random random(43);
  for (int i = 0; i < effort(60, 12); ++i) {
    const ExternalSpheres external = random_external(random, i);
    const Clearance clearance(external);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = random.in_box(kAround);
      const Digits50 exact = exact_clearance(p, external);
      const ClearanceAt at = clearance(p);
      ASSERT_LE(Digits50(at.lower), exact);
      ASSERT_GE(Digits50(at.upper), exact);
      ASSERT_LE(at.upper - at.lower, 1e-12);
      ASSERT_NEAR(at.away.norm(), 1.0, 1e-12);
      ASSERT_TRUE(clearance.is_at_least(p, at.lower - 1e-12));
      ASSERT_FALSE(clearance.is_at_least(p, at.upper + 1e-12));
    }
  }
}

TEST(Clearance, ALimitKeepsTheBoundsTrue) {
  Random random(44);
  for (int i = 0; i < effort(60, 12); ++i) {
    const ExternalSpheres external = random_external(random, i);
    const Clearance clearance(external);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = random.in_box(kAround);
      const Digits50 exact = exact_clearance(p, external);
      const double limit = random.between(0.0, 1.0);
      const ClearanceAt limited = clearance(p, limit);
      ASSERT_LE(Digits50(limited.lower), exact);
      ASSERT_GE(Digits50(limited.upper), exact);
      if (exact < limit - 1e-12) {
        ASSERT_LE(limited.upper - limited.lower, 1e-12);
      } else if (!external.spheres.empty()) {
        ASSERT_LE(limited.lower, limit);
        ASSERT_GE(limited.lower, std::min(limit, static_cast<double>(exact)) - 1e-12);
      }
    }
  }
}

// Clearance is a distance to a set inside of S and one less the other way outside: it changes by no
// more than the way that the point is moved, and by just that way in the direction `away`.
TEST(Clearance, IsLipschitzAndRisesInTheDirectionAway) {
  Random random(45);
  int rises = 0;
  for (int i = 0; i < effort(60, 12); ++i) {
    const ExternalSpheres external = random_external(random, i);
    const Clearance clearance(external);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = random.in_box(kAround);
      const double way = random.between(0.0, 0.5);
      const ClearanceAt here = clearance(p);
      const ClearanceAt there = clearance(p + way * random.direction());
      ASSERT_LE(there.lower, here.upper + way + 1e-12);
      ASSERT_GE(there.upper, here.lower - way - 1e-12);
      const double small = 1e-7;
      if (clearance(p + small * here.away).lower > here.upper + 0.99 * small) ++rises;
    }
  }
  EXPECT_GT(rises, effort(60, 12) * 40 * 9 / 10);
}

}  // namespace
}  // namespace spherule::test
