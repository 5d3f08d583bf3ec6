// SPDX-License-Identifier: BSD-3-Clause
// The bound against points of the cell in long double, among them those where it is nearly reached:
// corners and points of the excluded sphere.
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/solid_query.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test::furthest_outside_test {
namespace {

using Eigen::Vector3d;
using internal::BoxCell;
using internal::furthest_outside;
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
}  // namespace spherule::test::furthest_outside_test
