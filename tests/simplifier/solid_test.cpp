// SPDX-License-Identifier: BSD-3-Clause
// Queries of S, its clearance and its external spheres, against 50 digits, long double and loops
// over all spheres.
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/nearest_cells.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using internal::BoxCell;
using internal::Clearance;
using internal::ClearanceAt;
using internal::furthest_outside;
using internal::NearestCells;
using internal::NearestSphere;
using internal::solid_point_in_groove;
using internal::SphereHierarchy;

// Of all sizes; those of an odd `kind` line a plane, with radii up to it, as external spheres do.
std::vector<Sphere> random_spheres(Random& random, std::size_t count, int kind, double scale,
                                   const Vector3d& shift) {
  const AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d c = random.in_box(box);
    const double radius = kind % 2 == 1 ? c.z() : random.between(0.0, kind % 3 == 0 ? 0.1 : 1.5);
    spheres.push_back({scale * c + shift, scale * radius});
  }
  return spheres;
}

Real exact_gap(const Vector3d& p, std::span<const Sphere> spheres) {
  Real gap(1e300);
  for (const Sphere& s : spheres) {
    gap = std::min(gap, Real(exact_distance(p, s.center) - s.radius));
  }
  return gap;
}

Real exact_clearance(const Vector3d& p, const ExternalSpheres& external) {
  Real least = exact_gap(p, external.spheres);
  for (int axis = 0; axis < 3; ++axis) {
    least = std::min({least, Real(p[axis]) - external.box.min()[axis],
                      Real(external.box.max()[axis]) - p[axis]});
  }
  return least;
}

ExternalSpheres random_external(Random& random, int i) {
  ExternalSpheres external;
  external.box = AlignedBox3d(Vector3d::Zero(), Vector3d::Constant(4));
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

template <class Bounded>
void expect_between(const Bounded& found, const Real& exact) {
  ASSERT_LE(Real(found.lower), exact);
  ASSERT_GE(Real(found.upper), exact);
}

const AlignedBox3d kAround(Vector3d::Constant(-1), Vector3d::Constant(5));

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
      const Real exact = exact_gap(p, spheres);
      const NearestSphere found = hierarchy.nearest(p);
      ASSERT_NO_FATAL_FAILURE(expect_between(found, exact));
      ASSERT_LE(found.upper - found.lower, 1e-13 * (10.0 * scale + shift.norm()));
      const Sphere& sphere = spheres.at(static_cast<std::size_t>(found.index));
      ASSERT_LE(exact_distance(p, sphere.center) - sphere.radius, Real(found.upper));
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
      const Real exact = exact_gap(p, spheres);
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
        ASSERT_NO_FATAL_FAILURE(expect_between(limited, exact));
      }
      const double tolerance = random.between(0.0, 0.3);
      const NearestSphere loose = hierarchy.nearest(p, kInfinity, tolerance);
      ASSERT_NO_FATAL_FAILURE(expect_between(loose, exact));
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
      const Real exact = exact_gap(p, spheres);
      const double tolerance = k % 4 < 2 ? 0.0 : 0.01;
      const NearestSphere found = hierarchy.nearest(p, kInfinity, tolerance);
      ASSERT_NO_FATAL_FAILURE(expect_between(found, exact));
      ASSERT_LE(found.upper - found.lower, tolerance + 1e-12);
    }
  }
}

TEST(Clearance, BoundsContainTheExactValue) {
  Random random(43);
  for (int i = 0; i < effort(60, 12); ++i) {
    const ExternalSpheres external = random_external(random, i);
    const Clearance clearance(external);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = random.in_box(kAround);
      const Real exact = exact_clearance(p, external);
      const ClearanceAt at = clearance(p);
      ASSERT_NO_FATAL_FAILURE(expect_between(at, exact));
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
      const Real exact = exact_clearance(p, external);
      const double limit = random.between(0.0, 1.0);
      const ClearanceAt limited = clearance(p, limit);
      ASSERT_NO_FATAL_FAILURE(expect_between(limited, exact));
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

// --- nearest cells: the answers have to be those of a loop over all spheres, to the last bit ---

// The least value, as computed, below the limit, and the first sphere that has it.
struct Least {
  double value;
  std::int32_t index = -1;
};
Least least_of_all(const std::vector<Sphere>& spheres, const Vector3d& p, double limit) {
  Least least{limit};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double value = std::sqrt((p - spheres[i].center).squaredNorm()) - spheres[i].radius;
    if (value < least.value) least = {value, static_cast<std::int32_t>(i)};
  }
  return least;
}

void expect_least(const NearestSphere& found, const Least& least, double length) {
  ASSERT_EQ(found.index, least.index);
  if (std::isinf(least.value)) {
    ASSERT_EQ(found.lower, least.value);
    return;
  }
  // What is charged for rounding does not tell values apart: the interval has to be about the
  // value.
  const double slack = 8.0 * kUnitRoundoff * (std::abs(least.value) + length) + kUnderflow;
  ASSERT_EQ(found.lower, sub_down(sub_down(least.value, 0.0), slack));
  ASSERT_EQ(found.upper, least.index < 0 ? least.value : add_up(least.value, slack));
}

double length_of(const std::vector<Sphere>& spheres, const Vector3d& p) {
  double radius = 0.0;
  double norm = 0.0;
  for (const Sphere& s : spheres) {
    radius = std::max(radius, s.radius);
    norm = std::max(norm, s.center.norm());
  }
  return p.norm() + norm + radius;
}

enum class Kind { kAny, kPlane, kRod, kShell, kGrid, kSame, kCount };

// In and about the box [0, 4]^3: of any size, or as they line a plane, a rod or a shell (nearly
// tied at its middle), at nodes of a grid (tied exactly), or all but a few the same.
std::vector<Sphere> spheres_of(Kind kind, std::size_t count, Random& random) {
  const AlignedBox3d around(Vector3d::Constant(-1), Vector3d::Constant(5));
  const Vector3d middle = Vector3d::Constant(2);
  std::vector<Sphere> spheres;
  while (spheres.size() < count) {
    const Vector3d c = random.in_box(around);
    const double large =
        random.index(5) == 0 ? random.between(1.0, 20.0) : random.between(0.5, 0.6);
    if (kind == Kind::kAny) {
      spheres.push_back({c, random.index(3) == 0 ? 0.0 : random.between(0.0, 1.5)});
    } else if (kind == Kind::kPlane) {
      spheres.push_back({{c.x(), c.y(), 3.0 + large}, large});
    } else if (kind == Kind::kRod) {
      const Vector3d out = Vector3d(c.x() - 2.0, c.y() - 2.0, 0.0).normalized();
      spheres.push_back({Vector3d(2, 2, c.z()) + (1.0 + large) * out, large});
    } else if (kind == Kind::kShell) {
      spheres.push_back({middle + (1.5 + large) * random.direction(), large});
    } else if (kind == Kind::kGrid) {
      spheres.push_back({(4.0 * c).array().round() / 4.0, 0.25});
    } else {
      spheres.push_back({random.index(50) == 0 ? c : middle, 0.5});
    }
  }
  return spheres;
}

// Anywhere in [0, 4]^3, close together, on the seams of cells, and at centres.
Vector3d query_point(const std::vector<Sphere>& spheres, int k, const Vector3d& cluster,
                     Random& random) {
  const AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  Vector3d p = random.in_box(box);
  if (k % 3 == 1) p = cluster + 0.02 * (p - Vector3d::Constant(2));
  if (k % 10 == 0) p = (8.0 * p).array().round() / 8.0;
  if (k % 17 == 0) p = spheres[random.index(spheres.size())].center;
  if (k % 19 == 0) p = Vector3d::Constant(2);
  return p.cwiseMax(box.min()).cwiseMin(box.max());
}

std::vector<Sphere> placed(std::vector<Sphere> spheres, double scale, const Vector3d& shift) {
  for (Sphere& s : spheres) s = {scale * s.center + shift, scale * s.radius};
  return spheres;
}

TEST(NearestCells, AnswersWithTheLeastOfAllValues) {
  Random random(71);
  std::size_t cells_made = 0;
  for (int i = 0; i < effort(60, 12); ++i) {
    const auto kind = static_cast<Kind>(i % static_cast<int>(Kind::kCount));
    const double scale = i % 4 == 0 ? 1e-6 : i % 4 == 1 ? 1e6 : 1.0;
    const Vector3d shift = i % 4 == 2 ? Vector3d(1e6, 1e6, -1e6) : Vector3d(0, 0, 0);
    const std::size_t count = i % 7 == 0 ? 1 + random.index(20) : 1000 + random.index(3000);
    const std::vector<Sphere> unplaced = spheres_of(kind, count, random);
    const std::vector<Sphere> spheres = placed(unplaced, scale, shift);
    const SphereHierarchy hierarchy(spheres);
    const AlignedBox3d box(shift, Vector3d::Constant(4.0 * scale) + shift);
    const NearestCells cells(spheres, box);
    const NearestCells no_room(spheres, box, 0);
    const Vector3d cluster = random.in_box({Vector3d::Constant(0.5), Vector3d::Constant(3.5)});
    for (int k = 0; k < 400; ++k) {
      const Vector3d p = (scale * query_point(unplaced, k, cluster, random) + shift)
                             .cwiseMax(box.min())
                             .cwiseMin(box.max());
      double limit = k % 2 == 0 ? kInfinity : scale * random.between(-0.5, 1.0);
      const double value = least_of_all(spheres, p, kInfinity).value;
      if (k % 5 == 0) limit = k % 10 == 0 ? value : std::nextafter(value, kInfinity);
      const Least least = least_of_all(spheres, p, limit);
      const double length = length_of(spheres, p);
      // First by a search, where few queries have come; then from lists.
      ASSERT_NO_FATAL_FAILURE(expect_least(cells.nearest(p, limit), least, length))
          << "set " << i << ", point " << k;
      for (int again = 0; again < 30; ++again) cells.nearest(p, limit);
      ASSERT_NO_FATAL_FAILURE(expect_least(cells.nearest(p, limit), least, length))
          << "set " << i << ", point " << k << ", from a list";
      if (k % 23 != 0) continue;
      ASSERT_NO_FATAL_FAILURE(expect_least(no_room.nearest(p, limit), least, length));
      const NearestSphere searched = hierarchy.nearest(p, limit);
      ASSERT_EQ(searched.index, least.index);
      ASSERT_EQ(searched.lower, cells.nearest(p, limit).lower);
      ASSERT_EQ(searched.upper, cells.nearest(p, limit).upper);
      ASSERT_FALSE(cells.is_any_nearer(p, value));
      ASSERT_TRUE(cells.is_any_nearer(p, std::nextafter(value, kInfinity)));
    }
    cells_made += cells.memory_used() > 0 ? 1 : 0;
    EXPECT_EQ(no_room.memory_used(), 0U);
  }
  EXPECT_GT(cells_made, 0U);
}

// Those that are left out are above the affine function all over the cell.
TEST(NearestCells, GathersAllSpheresThatAreSomewhereBelowAnAffineFunction) {
  Random random(75);
  const AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  std::size_t left_out = 0;
  for (int i = 0; i < effort(300, 60); ++i) {
    const auto kind = static_cast<Kind>(i % static_cast<int>(Kind::kCount));
    const std::vector<Sphere> spheres = spheres_of(kind, 1 + random.index(600), random);
    const SphereHierarchy hierarchy(spheres);
    const Vector3d half = std::pow(0.1, random.between(0.0, 3.0)) *
                          random.in_box({Vector3d::Constant(0.1), Vector3d::Constant(1)});
    const internal::BoxCell cell{random.in_box(box), half};
    const double value = random.between(-0.5, 1.5);
    const Vector3d slope = random.between(0.0, 1.0) * random.direction();
    std::vector<char> visited(spheres.size(), 0);
    hierarchy.for_each_below(cell, value, slope, [&](std::int32_t k) {
      visited[static_cast<std::size_t>(k)] = 1;
      return true;
    });
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      if (visited[k] != 0) continue;
      ++left_out;
      // The corners, the centre, the point nearest to the centre of the sphere, and others.
      for (int j = 0; j < 16; ++j) {
        const Vector3d corner((j & 1) != 0 ? half.x() : -half.x(),
                              (j & 2) != 0 ? half.y() : -half.y(),
                              (j & 4) != 0 ? half.z() : -half.z());
        const Vector3d nearest = (spheres[k].center - cell.center).cwiseMin(half).cwiseMax(-half);
        const Vector3d out = j < 8    ? corner
                             : j == 8 ? Vector3d::Zero()
                             : j == 9 ? nearest
                                      : random.in_box({-half, half});
        const double gap = (cell.center + out - spheres[k].center).norm() - spheres[k].radius;
        ASSERT_GT(gap, value + slope.dot(out)) << "set " << i << ", sphere " << k;
      }
    }
  }
  EXPECT_GT(left_out, 1000U);
}

TEST(NearestCells, SearchesOutsideOfTheBoxAndWhereTooManyAreTied) {
  Random random(72);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 6000; ++i)
    spheres.push_back({Vector3d(2, 2, 2) + 3.0 * random.direction(), 1});
  const SphereHierarchy hierarchy(spheres);
  const NearestCells cells(spheres, {Vector3d::Zero(), Vector3d::Constant(4)});
  for (int k = 0; k < 400; ++k) {
    Vector3d p = random.in_box({Vector3d::Constant(-8), Vector3d::Constant(8)});
    // More spheres than a list holds are nearly tied here.
    if (k % 2 == 0) p = Vector3d::Constant(2) + 1e-6 * p;
    const double limit = k % 3 == 0 ? 1.0 : kInfinity;
    const NearestSphere searched = hierarchy.nearest(p, limit);
    const NearestSphere found = cells.nearest(p, limit);
    ASSERT_EQ(found.index, searched.index);
    ASSERT_EQ(found.lower, searched.lower);
    ASSERT_EQ(found.upper, searched.upper);
  }
}

TEST(NearestCells, KeepsToItsMemory) {
  Random random(73);
  const std::vector<Sphere> spheres = spheres_of(Kind::kRod, 4000, random);
  const AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  constexpr std::size_t kMemory = 50000;
  const NearestCells little(spheres, box, kMemory);
  const NearestCells much(spheres, box);
  for (int k = 0; k < 2000; ++k) {
    const Vector3d p = random.in_box(box);
    const NearestSphere found = little.nearest(p, kInfinity);
    const NearestSphere expected = much.nearest(p, kInfinity);
    ASSERT_EQ(found.index, expected.index);
    ASSERT_EQ(found.lower, expected.lower);
    ASSERT_LE(little.memory_used(), kMemory);
  }
  EXPECT_GT(much.memory_used(), kMemory);
}

TEST(NearestCells, AnswersThreadsAlike) {
  Random random(74);
  const std::vector<Sphere> spheres = spheres_of(Kind::kPlane, 4000, random);
  const AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
  std::vector<Vector3d> points;
  for (int k = 0; k < 4000; ++k) points.push_back(random.in_box(box));
  const NearestCells cells(spheres, box, 200000);
  std::vector<std::vector<std::int32_t>> found(4, std::vector<std::int32_t>(points.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < found.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t k = (i + t * 7) % points.size();
        found[t][k] = cells.nearest(points[k], kInfinity).index;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(cells.memory_used(), 200000U);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::int32_t expected = least_of_all(spheres, points[k], kInfinity).index;
    for (const std::vector<std::int32_t>& by_thread : found) ASSERT_EQ(by_thread[k], expected);
  }
}

TEST(NearestSphere, OfAnEmptySetIsInfinitelyFar) {
  const SphereHierarchy hierarchy;
  EXPECT_TRUE(hierarchy.empty());
  EXPECT_EQ(hierarchy.nearest({0, 0, 0}).lower, kInfinity);
  EXPECT_EQ(hierarchy.nearest({0, 0, 0}).index, -1);
  const NearestCells cells({}, {Vector3d::Zero(), Vector3d::Constant(4)});
  EXPECT_EQ(cells.nearest({1, 1, 1}, kInfinity).index, -1);
  EXPECT_EQ(cells.nearest({1, 1, 1}, kInfinity).lower, kInfinity);
  EXPECT_EQ(cells.nearest({9, 1, 1}, kInfinity).upper, kInfinity);
}

// --- solid query ---

// External spheres that meet in the origin, whose clearance therefore is about 0, and leave a
// groove or a pit open from there: along `opening` the clearances to all of them grow at a rate of
// `slope` at least.
ExternalSpheres grooved(Random& random, std::size_t count, const Vector3d& opening, double slope) {
  ExternalSpheres external;
  external.box = AlignedBox3d(Vector3d::Constant(-100), Vector3d::Constant(100));
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d across = opening.cross(random.direction()).normalized();
    // The second is opposite to the first, so that the groove is as acute as it may be.
    const Vector3d side = i == 1 ? Vector3d(-external.spheres.front().center) : across;
    const Vector3d level = (side - side.dot(opening) * opening).normalized();
    const double rise = slope * (i < 2 ? 1.0 : random.between(1.0, 2.0));
    const Vector3d normal = rise * opening + std::sqrt(1.0 - rise * rise) * level;
    const double radius = random.between(2.0, 6.0);
    external.spheres.push_back({-radius * normal, radius});
  }
  return external;
}

// Away from one contact alone, a point beside the edge of an acute groove stays outside of S.
TEST(SolidQuery, TheSolidIsFoundBesideTheEdgeOfAnAcuteGroove) {
  Random random(11);
  for (int i = 0; i < effort(2000, 300); ++i) {
    const Vector3d opening = random.direction();
    const ExternalSpheres external =
        grooved(random, 2 + random.index(3), opening, random.between(0.05, 0.45));
    const Clearance clearance(external);
    const double within = 0.02;
    const double away = within * std::pow(2.0, -random.between(8, 28));
    const Vector3d start = away * (random.direction() - opening);
    if (clearance(start).lower >= 0.0) continue;
    const auto found = solid_point_in_groove(clearance, start, away, within);
    ASSERT_TRUE(found) << "case " << i;
    ASSERT_GE(clearance(*found).lower, 0.0) << "case " << i;
    ASSERT_LE((*found - start).norm(), within) << "case " << i;
  }
}

// A point deep in external spheres has no point of S near.
TEST(SolidQuery, NothingIsFoundWhereTheSolidIsFar) {
  Random random(12);
  for (int i = 0; i < effort(300, 50); ++i) {
    ExternalSpheres external;
    external.box = AlignedBox3d(Vector3d::Constant(-100), Vector3d::Constant(100));
    for (std::size_t k = 0; k < 6; ++k) external.spheres.push_back({random.direction(), 1.2});
    const Clearance clearance(external);
    const double depth = -clearance(Vector3d::Zero()).upper;
    ASSERT_FALSE(solid_point_in_groove(clearance, Vector3d::Zero(), 1e-6, 0.99 * depth))
        << "case " << i;
  }
}

// --- furthest outside ---
// The bound against points of the cell in long double, among them those where it is nearly reached:
// corners and points of the excluded sphere.

using Exact = Eigen::Matrix<long double, 3, 1>;

Exact exact(const Vector3d& v) {
  return v.cast<long double>();
}

struct Case {
  BoxCell cell;
  Vector3d point;
  Sphere excluded;  // its surface passes through the cell, or near
};

// Sizes, distances and radii over twelve orders of magnitude, directions often opposite.
Case random_case(Random& random) {
  const auto size = [&] { return std::pow(10.0, random.between(-6.0, 6.0)); };
  const double scale = size();
  Case made;
  const double from_origin = random.between(0.0, 1e3) * scale;
  made.cell.center = from_origin * random.direction();
  for (int k = 0; k < 3; ++k) made.cell.half[k] = scale * random.between(0.0, 1.0);
  const Vector3d way = random.direction();
  made.point = made.cell.center - size() * scale * way;
  const double radius = size() * scale;
  const Vector3d side = random.index(3) == 0 ? random.direction() : way + 0.1 * random.direction();
  const double gap = random.between(-1.5, 1.5) * made.cell.reach();
  made.excluded = {made.cell.center + (radius + gap) * side.normalized(), radius};
  return made;
}

// A point of the cell: any, a corner, or moved along to the surface of the sphere.
Exact random_point(const Case& of, Random& random) {
  Exact share;
  for (int k = 0; k < 3; ++k) share[k] = random.between(-1.0, 1.0);
  if (random.index(4) == 0)
    share = share.unaryExpr([](long double s) { return s < 0 ? -1.L : 1.L; });
  const Exact x = exact(of.cell.center) + exact(of.cell.half).cwiseProduct(share);
  if (random.index(2) == 0) return x;
  const Exact from = x - exact(of.excluded.center);
  return exact(of.excluded.center) + from * (of.excluded.radius / from.norm());
}

bool is_in_cell(const BoxCell& cell, const Exact& x) {
  return ((x - exact(cell.center)).cwiseAbs().array() <= exact(cell.half).array()).all();
}

TEST(FurthestOutside, NoPointOfTheCellOutsideOfTheSphereIsFurther) {
  Random random(29);
  int compared = 0;
  for (int i = 0; i < effort(20'000, 2'000); ++i) {
    const Case made = random_case(random);
    const double bound = furthest_outside(made.cell, made.point, made.excluded);
    ASSERT_LE(bound, made.cell.furthest(made.point));
    for (int k = 0; k < 20; ++k) {
      const Exact x = random_point(made, random);
      const bool is_outside =
          (x - exact(made.excluded.center)).norm() >= made.excluded.radius * (1.0L - 1e-19L);
      if (!is_outside || !is_in_cell(made.cell, x)) continue;
      ++compared;
      ASSERT_LE((x - exact(made.point)).norm(), bound) << "case " << i;
    }
  }
  EXPECT_GT(compared, effort(100'000, 10'000));
}

// Where the centres are opposite and the corners towards `point` are on the sphere, the bound is
// reached there.
TEST(FurthestOutside, RoundsOutwards) {
  Random random(31);
  const auto size = [&] { return std::pow(10.0, random.between(-1.0, 2.0)); };
  int compared = 0;
  for (int i = 0; i < 10'000; ++i) {
    const int axis = static_cast<int>(random.index(3));
    BoxCell cell;
    for (int k = 0; k < 3; ++k) {
      cell.half[k] = size();
      cell.center[k] = random.between(-100.0, 100.0);
    }
    Vector3d point = cell.center, center = cell.center;
    point[axis] -= 10.0 * size();
    center[axis] += 10.0 * size();
    Exact corner = exact(cell.half);
    corner[axis] = -corner[axis];
    corner += exact(cell.center);
    const auto radius = static_cast<double>((corner - exact(center)).norm() * (1.0L - 0x1p-54L));
    if ((corner - exact(center)).norm() < radius) continue;
    const double bound = furthest_outside(cell, point, {center, radius});
    ASSERT_LE((corner - exact(point)).norm(), bound);
    if (bound < cell.furthest(point)) ++compared;
  }
  EXPECT_GT(compared, 5'000);
}

// Between opposite centres, what exceeds is of second order.
TEST(FurthestOutside, IsTightBetweenOppositeCentres) {
  const Sphere excluded{{150.05, 0, 0}, 50.0};
  const auto excess = [&](double half) {
    const BoxCell cell{{100, 0, 0}, Vector3d::Constant(half)};
    return furthest_outside(cell, Vector3d::Zero(), excluded) - 100.05;
  };
  EXPECT_LE(excess(0.1), 5e-4);
  EXPECT_LE(excess(1.0), 5e-2);
  EXPECT_GE(excess(0.1), 0.0);
}

TEST(FurthestOutside, ASphereAboutTheCellSaysNothing) {
  const BoxCell cell{{1, 2, 3}, {1, 1, 1}};
  EXPECT_EQ(furthest_outside(cell, Vector3d::Zero(), {cell.center, 0.5}),
            cell.furthest(Vector3d::Zero()));
}

}  // namespace
}  // namespace spherule::test
