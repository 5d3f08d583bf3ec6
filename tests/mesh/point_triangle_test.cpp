// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/point_triangle.h"

#include "tests/mesh/distance_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

enum class Kind { kOrdinary, kNeedle, kRepeatedCorner, kCollinear, kPoint, kNearlyCollinear };
constexpr std::array kKinds{Kind::kOrdinary,  Kind::kNeedle, Kind::kRepeatedCorner,
                            Kind::kCollinear, Kind::kPoint,  Kind::kNearlyCollinear};

Triangle random_triangle(Random& random, Kind kind) {
  const auto point = [&] { return Vector3d(random.direction() * random.unit()); };
  Triangle t{point(), point(), point()};
  const double along = random.between(-0.5, 1.5);
  switch (kind) {
    case Kind::kOrdinary:
      break;
    case Kind::kNeedle:
      t[2] = t[0] + 1e-7 * random.direction();
      break;
    case Kind::kRepeatedCorner:
      t[random.index(2) + 1] = t[0];
      break;
    case Kind::kCollinear:  // exactly: the coordinates are multiples of 1/16
      for (Vector3d& v : t) v = (v * 16.0).array().round() / 16.0;
      t[2] = t[0] + static_cast<double>(random.index(5)) * (t[1] - t[0]);
      break;
    case Kind::kPoint:
      t[1] = t[2] = t[0];
      break;
    case Kind::kNearlyCollinear:
      t[2] = t[0] + along * (t[1] - t[0]) + 1e-16 * random.direction();
      break;
  }
  return t;
}

// Somewhere in space, on a corner, on an edge, on the face, or just off one of these.
Vector3d random_query(Random& random, const Triangle& t) {
  const double u = random.unit();
  const double v = random.between(0.0, 1.0 - u);
  Vector3d p = random.direction() * random.between(0.0, 3.0);
  switch (random.index(5)) {
    case 0:
      p = t[random.index(3)];
      break;
    case 1:
      p = t[0] + u * (t[1] - t[0]);
      break;
    case 2:
      p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
      break;
    case 3:
      p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]) + 1e-9 * random.direction();
      break;
    default:
      break;
  }
  return p;
}

double reach(const Vector3d& p, const Triangle& t) {
  return std::max({(t[0] - p).norm(), (t[1] - p).norm(), (t[2] - p).norm()});
}

void expect_contains_the_exact_distance(const Vector3d& p, const Triangle& t) {
  const TriangleDistance d = point_triangle_distance(p, t[0], t[1], t[2]);
  const Digits50 exact = exact_triangle_distance(p, t[0], t[1], t[2]);
  ASSERT_LE(Digits50(d.lower), exact);
  ASSERT_GE(Digits50(d.upper), exact);
  ASSERT_GE(d.lower, 0.0);
}

TEST(PointTriangle, BoundsContainTheExactDistanceAtEveryScaleAndPlace) {
  Random random(11);
  for (int i = 0; i < effort(12000, 1500); ++i) {
    const double scale = std::array{1e-6, 1e-3, 1.0, 1e3, 1e6}[random.index(5)];
    const Vector3d shift =
        random.index(3) == 0 ? Vector3d(1e6 * random.direction()) : Vector3d(Vector3d::Zero());
    Triangle t = random_triangle(random, kKinds[random.index(kKinds.size())]);
    const Vector3d p = scale * random_query(random, t) + shift;
    for (Vector3d& v : t) v = scale * v + shift;
    SCOPED_TRACE("case " + std::to_string(i));
    ASSERT_NO_FATAL_FAILURE(expect_contains_the_exact_distance(p, t));
  }
}

// Products of coordinates underflow, or come near to overflow; the bounds still hold.
TEST(PointTriangle, BoundsContainTheExactDistanceAtExtremeScales) {
  Random random(12);
  for (int i = 0; i < effort(4000, 600); ++i) {
    const double scale =
        std::array{1e-300, 1e-170, 1e-155, 1e-140, 1e-100, 1e-50, 1e14}[random.index(7)];
    Triangle t = random_triangle(random, kKinds[random.index(kKinds.size())]);
    const Vector3d p = scale * random_query(random, t);
    for (Vector3d& v : t) v *= scale;
    SCOPED_TRACE("case " + std::to_string(i) + ", scale " + std::to_string(std::log10(scale)));
    ASSERT_NO_FATAL_FAILURE(expect_contains_the_exact_distance(p, t));
  }
}

TEST(PointTriangle, TheIntervalIsNarrowForOrdinaryTriangles) {
  Random random(13);
  for (int i = 0; i < effort(3000, 500); ++i) {
    const Triangle t = random_triangle(random, Kind::kOrdinary);
    const Vector3d p = random.direction() * random.between(1.5, 3.0);
    const TriangleDistance d = point_triangle_distance(p, t[0], t[1], t[2]);
    ASSERT_LE(d.upper - d.lower, 1e-14 * reach(p, t));
  }
}

// Widest where the point is next to the triangle, whose direction is then uncertain.
TEST(PointTriangle, TheIntervalIsNarrowForAllTrianglesAtAllHeights) {
  Random random(14);
  for (int i = 0; i < effort(200000, 5000); ++i) {
    const Kind kind = kKinds[random.index(kKinds.size())];
    const Triangle t = random_triangle(random, kind);
    const double u = random.unit();
    const double v = random.between(0.0, 1.0 - u);
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const bool upright = random.index(2) == 0 && normal.norm() > 0.0;
    const Vector3d p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]) +
                       std::pow(10.0, random.between(-13.0, 0.0)) *
                           (upright ? Vector3d(normal.normalized()) : random.direction());
    const TriangleDistance d = point_triangle_distance(p, t[0], t[1], t[2]);
    const double share = kind == Kind::kNeedle ? 1e-3 : 1e-5;
    ASSERT_LE(d.upper - d.lower, share * reach(p, t)) << "case " << i;
  }
}

// The returned point is as near as the interval says, and on the triangle up to rounding.
TEST(PointTriangle, TheClosestPointIsOnTheTriangleAndAsNearAsSaid) {
  Random random(14);
  for (int i = 0; i < effort(3000, 500); ++i) {
    const Triangle t = random_triangle(random, kKinds[random.index(kKinds.size())]);
    const Vector3d p = random_query(random, t);
    const TriangleDistance d = point_triangle_distance(p, t[0], t[1], t[2]);
    const double slack = 1e-14 * (reach(p, t) + p.norm());
    ASSERT_LE(exact_triangle_distance(d.closest, t[0], t[1], t[2]), Digits50(slack));
    ASSERT_LE(exact_distance(d.closest, p), Digits50(d.upper + slack));
  }
}

}  // namespace
}  // namespace spherule::test
