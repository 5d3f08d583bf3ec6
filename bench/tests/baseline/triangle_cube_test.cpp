// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/cell_octree.h"
#include "bench/tests/baseline/exact_cube.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Triangle;

struct Tally {
  int meet = 0;
  int apart = 0;
  int only_possibly = 0;  // said to meet, but apart
};

// Compares with the exact answer: never apart where they meet, and never together where even the
// cube grown by `slack` is apart.
Tally compare(int cases, const std::function<Triangle()>& make, const Vector3d& center, double half,
              double slack) {
  Tally tally;
  for (int i = 0; i < cases; ++i) {
    const Triangle triangle = make();
    const bool exact_answer = exactly_intersects(triangle, exact(center), Rational(half));
    const bool answer = internal::may_intersect(triangle, center, half);
    ++(exact_answer ? tally.meet : tally.apart);
    EXPECT_TRUE(answer || !exact_answer) << i;
    if (answer && !exact_answer) {
      ++tally.only_possibly;
      EXPECT_TRUE(exactly_intersects(triangle, exact(center), Rational(half) + Rational(slack)))
          << i;
    }
  }
  return tally;
}

TEST(TriangleIntersectsCube, AgreesWithRationalClipping) {
  Random random(1);
  const Eigen::AlignedBox3d field(Vector3d::Constant(-2.5), Vector3d::Constant(2.5));
  const Tally tally = compare(
      effort(20000, 2000),
      [&] {
        return Triangle{random.in_box(field), random.in_box(field), random.in_box(field)};
      },
      Vector3d::Zero(), 1.0, 1e-12);
  EXPECT_GT(tally.meet, tally.apart / 10);
  EXPECT_GT(tally.apart, tally.meet / 10);
}

// Coordinates on a coarse lattice: corners and edges on faces, edges and corners of the cube,
// triangles that are segments or points.
TEST(TriangleIntersectsCube, TouchingAndDegenerate) {
  Random random(2);
  const auto lattice = [&] {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = 0.5 * (static_cast<double>(random.index(13)) - 6.0);
    return p;
  };
  const Tally tally = compare(
      effort(20000, 2000),
      [&] {
        return Triangle{lattice(), lattice(), lattice()};
      },
      Vector3d::Zero(), 1.0, 1e-12);
  EXPECT_GT(tally.meet, effort(1000, 100));
  EXPECT_GT(tally.apart, effort(1000, 50));
}

// Moved so that the cube is touched in one point, give or take some units in the last place.
TEST(TriangleIntersectsCube, WithinRoundingOfTouching) {
  Random random(3);
  const Eigen::AlignedBox3d field(Vector3d::Constant(-3.0), Vector3d::Constant(3.0));
  for (const double offset : {0.0, 1e3, 1e9}) {
    const Vector3d center = Vector3d(offset + 1.0 / 3.0, -offset, 0.7 * offset);
    const Tally tally = compare(
        effort(5000, 400),
        [&] {
          Vector3d normal = random.direction();
          Vector3d corner;
          for (int k = 0; k < 3; ++k) corner[k] = normal[k] > 0.0 ? 1.0 : -1.0;
          const double by = 1e-16 * (static_cast<double>(random.index(41)) - 20.0);
          Triangle triangle;
          const Vector3d aside = normal.cross(random.direction());
          const double turns[] = {0.0, 2.1, 4.2};
          for (std::size_t k = 0; k < 3; ++k) {
            const Vector3d in_plane =
                std::cos(turns[k]) * aside + std::sin(turns[k]) * normal.cross(aside);
            triangle[k] = center + corner + by * normal + (1.0 + 40.0 * random.unit()) * in_plane;
          }
          return triangle;
        },
        center, 1.0, 1e-13 * (1.0 + offset));
    EXPECT_GT(tally.meet, effort(100, 4)) << offset;
    EXPECT_GT(tally.only_possibly, offset < 1e6 ? effort(10, 0) : -1) << offset;
  }
}

TEST(TriangleIntersectsCube, NeedlesAndGiants) {
  Random random(4);
  for (const double length : {1e3, 1e8}) {
    const Tally tally = compare(
        effort(5000, 500),
        [&] {
          const Vector3d through = 1.2 * random.direction();
          const Vector3d way = random.direction();
          const Vector3d a = through - length * way;
          return Triangle{a, Vector3d(through + length * way),
                          Vector3d(a + 1e-6 * random.direction())};
        },
        Vector3d::Zero(), 1.0, 1e-12 * length);
    EXPECT_GT(tally.meet, effort(100, 5));
    EXPECT_GT(tally.apart, effort(100, 5));
  }
}

}  // namespace
}  // namespace spherule::test
