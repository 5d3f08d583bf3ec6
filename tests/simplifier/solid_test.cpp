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
using internal::SphereHierarchy;

const AlignedBox3d kBox(Vector3d::Zero(), Vector3d::Constant(4));
const AlignedBox3d kAround(Vector3d::Constant(-1), Vector3d::Constant(5));

enum class Kind { kAny, kPlane, kRod, kShell, kGrid, kSame, kCount };

// In and about the box [0, 4]^3: of any size, or as they line a plane, a rod or a shell (nearly
// tied at its middle), at nodes of a grid (tied exactly), or all but a few the same.
std::vector<Sphere> spheres_of(Kind kind, std::size_t count, Random& random) {
  const Vector3d middle = Vector3d::Constant(2);
  std::vector<Sphere> spheres;
  while (spheres.size() < count) {
    const Vector3d c = random.in_box(kAround);
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

// Spheres of each kind in turn, at several scales and places.
struct Placed {
  double scale;
  Vector3d shift;
  std::vector<Sphere> unplaced;
  std::vector<Sphere> spheres;

  Placed(int i, std::size_t count, Random& random)
      : scale(i % 4 == 0   ? 1e-6
              : i % 4 == 1 ? 1e6
                           : 1.0),
        shift(i % 4 == 2 ? Vector3d(1e6, 1e6, -1e6) : Vector3d(0, 0, 0)),
        unplaced(spheres_of(static_cast<Kind>(i % static_cast<int>(Kind::kCount)), count, random)) {
    for (const Sphere& s : unplaced) spheres.push_back({at(s.center), scale * s.radius});
  }
  Vector3d at(const Vector3d& p) const { return scale * p + shift; }
};

Real exact_gap(const Vector3d& p, std::span<const Sphere> spheres) {
  Real gap(1e300);
  for (const Sphere& s : spheres) {
    gap = std::min(gap, Real(exact_distance(p, s.center) - s.radius));
  }
  return gap;
}

template <class Bounded>
void expect_between(const Bounded& found, const Real& exact) {
  ASSERT_LE(Real(found.lower), exact);
  ASSERT_GE(Real(found.upper), exact);
}

TEST(SphereHierarchy, BoundsContainTheExactGapAndAreLooseOnlyAsStated) {
  Random random(41);
  int within = 0;
  int beyond = 0;
  for (int i = 0; i < effort(90, 18); ++i) {
    const Placed of(i, 1 + random.index(150), random);
    const SphereHierarchy hierarchy(of.spheres);
    const double rounding = 1e-12 * (of.scale + of.shift.norm());
    for (int k = 0; k < 40; ++k) {
      Vector3d p = random.in_box(kAround);
      if (k % 4 == 0) p.head<2>() = Eigen::Vector2d::Constant(2) + 1e-3 * p.head<2>();  // tied
      p = k == 0 ? of.spheres.front().center : of.at(p);
      const Real exact = exact_gap(p, of.spheres);
      const double tolerance = k % 2 == 0 ? 0.0 : of.scale * random.between(0.0, 0.3);
      const NearestSphere found = hierarchy.nearest(p, kInfinity, tolerance);
      ASSERT_NO_FATAL_FAILURE(expect_between(found, exact));
      ASSERT_LE(found.upper - found.lower, tolerance + rounding);
      const Sphere& sphere = of.spheres.at(static_cast<std::size_t>(found.index));
      ASSERT_LE(exact_distance(p, sphere.center) - sphere.radius, Real(found.upper));
      const double limit = of.scale * random.between(-1.0, 1.0);
      const NearestSphere limited = hierarchy.nearest(p, limit);
      if (exact >= limit + rounding) {
        ++beyond;
        ASSERT_EQ(limited.index, -1);
        ASSERT_LE(limited.lower, limit);
        ASSERT_GE(limited.lower, limit - rounding);
        ASSERT_EQ(limited.upper, limit);
      } else if (exact < limit - rounding) {
        ++within;
        ASSERT_GE(limited.index, 0);
        ASSERT_NO_FATAL_FAILURE(expect_between(limited, exact));
      }
    }
  }
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 50);
}

Real exact_clearance(const Vector3d& p, const ExternalSpheres& external) {
  Real least = exact_gap(p, external.spheres);
  for (int axis = 0; axis < 3; ++axis) {
    least = std::min({least, Real(p[axis]) - external.box.min()[axis],
                      Real(external.box.max()[axis]) - p[axis]});
  }
  return least;
}

// A distance to a set inside of S and one less the other way outside: it changes by no more than
// the way that the point is moved, and by just that way in the direction `away`.
TEST(Clearance, BoundsContainTheExactValueWhichRisesInTheDirectionAway) {
  Random random(43);
  int rises = 0;
  for (int i = 0; i < effort(60, 12); ++i) {
    const auto kind = static_cast<Kind>(i % static_cast<int>(Kind::kCount));
    ExternalSpheres external;
    external.box = kBox;
    external.spheres = spheres_of(kind, i % 7 == 0 ? 0 : 1 + random.index(200), random);
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
      const double limit = random.between(0.0, 1.0);
      const ClearanceAt limited = clearance(p, limit);
      ASSERT_NO_FATAL_FAILURE(expect_between(limited, exact));
      if (exact < limit - 1e-12) {
        ASSERT_LE(limited.upper - limited.lower, 1e-12);
      } else if (!external.spheres.empty()) {
        ASSERT_LE(limited.lower, limit);
        ASSERT_GE(limited.lower, std::min(limit, static_cast<double>(exact)) - 1e-12);
      }
      const double way = random.between(0.0, 0.5);
      const ClearanceAt there = clearance(p + way * random.direction());
      ASSERT_LE(there.lower, at.upper + way + 1e-12);
      ASSERT_GE(there.upper, at.lower - way - 1e-12);
      const double small = 1e-7;
      if (clearance(p + small * at.away).lower > at.upper + 0.99 * small) ++rises;
    }
  }
  EXPECT_GT(rises, effort(60, 12) * 40 * 4 / 5);
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

void expect_equal(const NearestSphere& found, const NearestSphere& expected) {
  ASSERT_EQ(found.index, expected.index);
  ASSERT_EQ(found.lower, expected.lower);
  ASSERT_EQ(found.upper, expected.upper);
}

// Anywhere in [0, 4]^3, close together, on the seams of cells, and at centres.
Vector3d query_point(const std::vector<Sphere>& spheres, int k, const Vector3d& cluster,
                     Random& random) {
  Vector3d p = random.in_box(kBox);
  if (k % 3 == 1) p = cluster + 0.02 * (p - Vector3d::Constant(2));
  if (k % 10 == 0) p = (8.0 * p).array().round() / 8.0;
  if (k % 17 == 0) p = spheres[random.index(spheres.size())].center;
  if (k % 19 == 0) p = Vector3d::Constant(2);
  return p.cwiseMax(kBox.min()).cwiseMin(kBox.max());
}

TEST(NearestCells, AnswersWithTheLeastOfAllValues) {
  Random random(71);
  std::size_t cells_made = 0;
  for (int i = 0; i < effort(60, 12); ++i) {
    const Placed of(i, i % 7 == 0 ? 1 + random.index(20) : 1000 + random.index(3000), random);
    const SphereHierarchy hierarchy(of.spheres);
    const AlignedBox3d box(of.at(kBox.min()), of.at(kBox.max()));
    const NearestCells cells(of.spheres, box);
    const NearestCells no_room(of.spheres, box, 0);
    const Vector3d cluster = random.in_box({Vector3d::Constant(0.5), Vector3d::Constant(3.5)});
    for (int k = 0; k < 400; ++k) {
      SCOPED_TRACE("set " + std::to_string(i) + ", point " + std::to_string(k));
      const Vector3d p = of.at(query_point(of.unplaced, k, cluster, random))
                             .cwiseMax(box.min())
                             .cwiseMin(box.max());
      double limit = k % 2 == 0 ? kInfinity : of.scale * random.between(-0.5, 1.0);
      const double value = least_of_all(of.spheres, p, kInfinity).value;
      if (k % 5 == 0) limit = k % 10 == 0 ? value : std::nextafter(value, kInfinity);
      const NearestSphere expected = hierarchy.nearest(p, limit);
      ASSERT_EQ(expected.index, least_of_all(of.spheres, p, limit).index);
      // First by a search, where few queries have come; then from lists.
      for (int again = 0; again < 32; ++again) {
        ASSERT_NO_FATAL_FAILURE(expect_equal(cells.nearest(p, limit), expected));
      }
      if (k % 23 != 0) continue;
      ASSERT_NO_FATAL_FAILURE(expect_equal(no_room.nearest(p, limit), expected));
      ASSERT_FALSE(cells.is_any_nearer(p, value));
      ASSERT_TRUE(cells.is_any_nearer(p, std::nextafter(value, kInfinity)));
    }
    cells_made += cells.memory_used() > 0 ? 1 : 0;
    EXPECT_EQ(no_room.memory_used(), 0U);
  }
  EXPECT_GT(cells_made, 0U);
}

TEST(NearestCells, SearchesOutsideOfTheBoxAndWhereTooManyAreTied) {
  Random random(72);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 6000; ++i) {
    spheres.push_back({Vector3d(2, 2, 2) + 3.0 * random.direction(), 1});
  }
  const SphereHierarchy hierarchy(spheres);
  const NearestCells cells(spheres, kBox);
  for (int k = 0; k < 400; ++k) {
    Vector3d p = random.in_box({Vector3d::Constant(-8), Vector3d::Constant(8)});
    // More spheres than a list holds are nearly tied here.
    if (k % 2 == 0) p = Vector3d::Constant(2) + 1e-6 * p;
    const double limit = k % 3 == 0 ? 1.0 : kInfinity;
    ASSERT_NO_FATAL_FAILURE(expect_equal(cells.nearest(p, limit), hierarchy.nearest(p, limit)));
  }
}

TEST(NearestCells, AnswersThreadsAlikeAndKeepsToItsMemory) {
  Random random(74);
  const std::vector<Sphere> spheres = spheres_of(Kind::kPlane, 4000, random);
  std::vector<Vector3d> points;
  for (int k = 0; k < 4000; ++k) points.push_back(random.in_box(kBox));
  constexpr std::size_t kMemory = 50000;
  const NearestCells cells(spheres, kBox, kMemory);
  const NearestCells much(spheres, kBox);
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
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::int32_t expected = least_of_all(spheres, points[k], kInfinity).index;
    for (const std::vector<std::int32_t>& by_thread : found) ASSERT_EQ(by_thread[k], expected);
    ASSERT_EQ(much.nearest(points[k], kInfinity).index, expected);
  }
  EXPECT_LE(cells.memory_used(), kMemory);
  EXPECT_GT(much.memory_used(), kMemory);
}

TEST(NearestSphere, OfAnEmptySetIsInfinitelyFar) {
  const SphereHierarchy hierarchy;
  EXPECT_TRUE(hierarchy.empty());
  const NearestCells cells({}, kBox);
  const NearestSphere none;
  EXPECT_NO_FATAL_FAILURE(expect_equal(hierarchy.nearest({0, 0, 0}), none));
  EXPECT_NO_FATAL_FAILURE(expect_equal(cells.nearest({1, 1, 1}, kInfinity), none));
  EXPECT_NO_FATAL_FAILURE(expect_equal(cells.nearest({9, 1, 1}, kInfinity), none));
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

}  // namespace
}  // namespace spherule::test
