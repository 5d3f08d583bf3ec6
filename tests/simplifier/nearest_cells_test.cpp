// SPDX-License-Identifier: BSD-3-Clause
// The answers have to be those of a loop over all spheres, to the last bit.
#include "simplifier/solid/nearest_cells.h"

#include "simplifier/solid/cells.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

namespace spherule::test::nearest_cells_test {
namespace {

using Eigen::Vector3d;
using internal::NearestCells;
using internal::NearestSphere;
using internal::SphereHierarchy;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  const Eigen::AlignedBox3d around(Vector3d::Constant(-1), Vector3d::Constant(5));
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
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
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
    const Eigen::AlignedBox3d box(shift, Vector3d::Constant(4.0 * scale) + shift);
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
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
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
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
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
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(4));
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

TEST(NearestCells, AnEmptySetIsInfinitelyFar) {
  const NearestCells cells({}, {Vector3d::Zero(), Vector3d::Constant(4)});
  EXPECT_EQ(cells.nearest({1, 1, 1}, kInfinity).index, -1);
  EXPECT_EQ(cells.nearest({1, 1, 1}, kInfinity).lower, kInfinity);
  EXPECT_EQ(cells.nearest({9, 1, 1}, kInfinity).upper, kInfinity);
}

}  // namespace
}  // namespace spherule::test::nearest_cells_test
