// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_distance.h"

#include "geometry/point_triangle.h"
#include "geometry/shells.h"
#include "geometry/triangle_mesh.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

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

// Also where products of coordinates underflow, or come near to overflow. Of ordinary triangles
// and points off them the interval is narrow.
TEST(PointTriangle, BoundsContainTheExactDistanceAtEveryScaleAndPlace) {
  constexpr std::array kScales{1e-300, 1e-170, 1e-155, 1e-140, 1e-100, 1e-50,
                               1e-6,   1e-3,   1.0,    1e3,    1e6,    1e14};
  Random random(11);
  for (int i = 0; i < effort(16000, 2000); ++i) {
    const double scale = kScales[random.index(kScales.size())];
    const bool is_shifted = std::abs(std::log10(scale)) < 7.0 && random.index(3) == 0;
    const Vector3d shift = (is_shifted ? 1e6 : 0.0) * random.direction();
    const Kind kind = kKinds[random.index(kKinds.size())];
    Triangle t = random_triangle(random, kind);
    Vector3d p = random_query(random, t);
    const bool is_narrow = kind == Kind::kOrdinary && scale == 1.0 && !is_shifted && p.norm() > 1.5;
    p = scale * p + shift;
    for (Vector3d& v : t) v = scale * v + shift;
    const TriangleDistance d = point_triangle_distance(p, t[0], t[1], t[2]);
    const Real exact = exact_triangle_distance(p, t);
    ASSERT_LE(Real(d.lower), exact) << "case " << i << ", scale " << scale;
    ASSERT_GE(Real(d.upper), exact) << "case " << i << ", scale " << scale;
    ASSERT_GE(d.lower, 0.0);
    if (!is_narrow) continue;
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
    ASSERT_LE(exact_triangle_distance(d.closest, t), Real(slack));
    ASSERT_LE(exact_distance(d.closest, p), Real(d.upper + slack));
  }
}

TriangleMesh scaled(TriangleMesh mesh, double scale, const Vector3d& shift) {
  for (Vector3d& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

// In the box grown by half, on a vertex, or near the middle of a triangle.
Vector3d query_of_mesh(Random& random, const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
  const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  switch (random.index(4)) {
    case 0:
      return vertex(static_cast<int>(random.index(3)));
    case 1:
      return (vertex(0) + vertex(1) + vertex(2)) / 3.0 +
             1e-6 * box.diagonal().norm() * random.direction();
    default:
      return random.in_box({box.min() - box.sizes() / 2.0, box.max() + box.sizes() / 2.0});
  }
}

TEST(MeshDistance, BoundsContainTheExactDistanceOnTheZoo) {
  Random random(21);
  for (const NamedMesh& named : mesh_zoo()) {
    SCOPED_TRACE(named.name);
    for (const double scale : {1e-6, 1.0, 1e6}) {
      const Vector3d shift = scale == 1.0 ? Vector3d(1e6, -1e6, 1e6) : Vector3d(0, 0, 0);
      const TriangleMesh mesh = scaled(named.mesh, scale, shift);
      const MeshDistance distance(mesh);
      for (int i = 0; i < effort(40, 4); ++i) {
        const Vector3d p = query_of_mesh(random, mesh, distance.box());
        const SurfaceDistance d = distance(p);
        const Real exact = exact_mesh_distance(p, mesh);
        ASSERT_LE(Real(d.lower), exact);
        ASSERT_GE(Real(d.upper), exact);
        const double size = distance.box().diagonal().norm() + p.norm();
        ASSERT_LE(d.upper - d.lower, 1e-5 * size);
        ASSERT_LE(exact_distance(d.closest, p), Real(d.upper + 1e-14 * size));
        const auto triangle = corners_of(mesh, static_cast<std::size_t>(d.triangle));
        ASSERT_LE(exact_triangle_distance(d.closest, triangle), 1e-14 * size);
      }
    }
  }
}

TEST(MeshDistance, WithALimitOnlyNearerTrianglesAreFound) {
  Random random(23);
  const TriangleMesh mesh = torus(1.0, 0.3, 24, 12);
  const MeshDistance distance(mesh);
  int found = 0;
  int missed = 0;
  for (int i = 0; i < effort(3000, 500); ++i) {
    const Vector3d p = query_of_mesh(random, mesh, distance.box());
    const SurfaceDistance whole = distance(p);
    const double limit = random.between(0.0, 1.0);
    const SurfaceDistance d = distance(p, limit);
    if (whole.upper < limit) {
      ++found;
      ASSERT_GE(d.triangle, 0);
      ASSERT_EQ(d.upper, whole.upper);
      ASSERT_LE(d.lower, whole.upper);
      ASSERT_GE(d.lower, whole.lower - 1e-14);
    } else if (whole.lower > limit) {
      ++missed;
      ASSERT_EQ(d.triangle, -1);
      ASSERT_LE(d.lower, limit);
      ASSERT_GE(d.lower, limit * (1.0 - 1e-12) - 1e-14);
      ASSERT_EQ(d.upper, std::numeric_limits<double>::infinity());
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(missed, 100);
}

// The square of the limit vanishes.
// About the centre of a ball all triangles are equally far.
TEST(MeshDistance, WithFewLeavesNoMoreIsClaimedThanIsKnown) {
  const TriangleMesh mesh = icosphere(3);
  const MeshDistance distance(mesh);
  Random random(24);
  const double infinity = std::numeric_limits<double>::infinity();
  int ended = 0;
  for (int n = 0; n < 200; ++n) {
    const Vector3d p = random.between(0.0, 0.9) * random.direction();
    const SurfaceDistance all = distance(p);
    for (const std::size_t most : {std::size_t{0}, std::size_t{3}, std::size_t{100000}}) {
      const SurfaceDistance some = distance(p, infinity, most);
      EXPECT_LE(some.lower, all.upper);
      EXPECT_GE(some.upper, all.lower);
      const bool is_complete = some.lower == all.lower && some.upper == all.upper;
      EXPECT_TRUE(is_complete || some.lower == 0.0);
      EXPECT_TRUE(is_complete || most < 100000);
      ended += is_complete ? 0 : 1;
    }
  }
  EXPECT_GT(ended, 200);
}

// The surface itself is at the distance of the limit: neither answer may claim more than is true.
TEST(MeshDistance, ALimitEqualToTheDistanceIsSound) {
  const MeshDistance distance(cube_mesh());
  for (const double limit :
       {0.5, std::nextafter(0.5, 0.0), std::nextafter(0.5, 1.0), 0.5 + 1e-15}) {
    const SurfaceDistance d = distance({0.5, 0.5, 1.5}, limit);
    EXPECT_LE(d.lower, 0.5);
    EXPECT_GE(d.upper, 0.5);
  }
  // The square of the limit vanishes.
  for (const double limit : {1e-150, 1e-170, 1e-310, 0.0}) {
    EXPECT_EQ(distance({0.5, 0.5, 1.0}, limit).lower, 0.0) << limit;
  }
}

TEST(MeshDistance, WindingNumbersOfClosedMeshesAreWhole) {
  const MeshDistance cube(cube_mesh());
  EXPECT_NEAR(cube.winding_number({0.3, 0.4, 0.6}), 1.0, 1e-12);
  EXPECT_NEAR(cube.winding_number({1.3, 0.4, 0.6}), 0.0, 1e-12);
  const MeshDistance inside_out(inverted(cube_mesh()));
  EXPECT_NEAR(inside_out.winding_number({0.3, 0.4, 0.6}), -1.0, 1e-12);
  const MeshDistance twice(with_duplicates(cube_mesh()));
  EXPECT_NEAR(twice.winding_number({0.3, 0.4, 0.6}), 2.0, 1e-12);
  // Outside, outer shell, cavity, core.
  const MeshDistance shells(nested_shells(3));
  EXPECT_NEAR(shells.winding_number({0.05, 0.5, 0.5}), 1.0, 1e-12);
  EXPECT_NEAR(shells.winding_number({0.2, 0.5, 0.5}), 0.0, 1e-12);
  EXPECT_NEAR(shells.winding_number({0.5, 0.5, 0.5}), 1.0, 1e-12);
  EXPECT_NEAR(shells.winding_number({-0.1, 0.5, 0.5}), 0.0, 1e-12);
}

TEST(MeshDistance, TheBoxIsOfTheVerticesThatTrianglesUse) {
  TriangleMesh mesh = cube_mesh();
  mesh.vertices.emplace_back(100, 100, 100);
  const MeshDistance distance(mesh);
  EXPECT_EQ(distance.box().max(), Vector3d(1, 1, 1));
  EXPECT_EQ(distance.triangle_count(), 12U);
}

// Points of the box that are clearly off the surface.
std::vector<Vector3d> points_off(const MeshDistance& distance, std::size_t count) {
  Random random(31);
  const Eigen::AlignedBox3d& box = distance.box();
  const double size = box.diagonal().norm();
  std::vector<Vector3d> points;
  for (int i = 0; points.size() < count && i < 1000000; ++i) {
    const Vector3d p =
        random.in_box({box.min() - box.sizes() / 8.0, box.max() + box.sizes() / 8.0});
    if (distance(p).lower > 1e-4 * size) points.push_back(p);
  }
  return points;
}

// Outside of hollows, where parts may take each other's inside away, a ray says what the solid
// angles say.
TEST(ClosedShells, WhatIsCountedAlongARayIsThatOfTheSolidAngles) {
  std::size_t inside = 0;
  for (const NamedMesh& named : mesh_zoo()) {
    SCOPED_TRACE(named.name);
    const MeshDistance distance(named.mesh);
    const internal::ClosedShells shells(named.mesh, distance);
    if (!shells.is_mesh_closed()) continue;
    for (const Vector3d& p : points_off(distance, static_cast<std::size_t>(effort(300, 30)))) {
      const bool is_inside = shells.contain(p);
      if (mesh_report(named.mesh).components == 1) {
        ASSERT_EQ(is_inside, std::lround(distance.winding_number(p)) != 0);
      } else if (std::lround(distance.winding_number(p)) != 0) {
        ASSERT_TRUE(is_inside);
      }
      inside += is_inside ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100U);
}

// The rays from these points run through edges and corners, whatever their direction.
TEST(ClosedShells, RaysThroughEdgesAndCornersDoNotChangeTheNumber) {
  const Vector3d along[] = {{0.4517, 0.6293, 0.6323},
                            {-0.7411, 0.3079, 0.5966},
                            {0.5381, -0.8114, 0.2281},
                            {-0.2893, -0.4729, -0.8323}};
  // A pyramid in each of the directions tried, with its tip there, all seen from the origin.
  TriangleMesh mesh = box_mesh(Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
  for (const Vector3d& d : along) {
    const Vector3d across = d.unitOrthogonal();
    const Vector3d third = d.cross(across);
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& v : {Vector3d(2.0 * d), Vector3d(4.0 * d + across),
                              Vector3d(4.0 * d + third), Vector3d(4.0 * d - across - third)}) {
      mesh.vertices.push_back(v);
    }
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(0, 3, 2),
                                     Eigen::Vector3i(0, 1, 3), Eigen::Vector3i(1, 2, 3)}) {
      mesh.triangles.emplace_back(t.array() + first);
    }
  }
  const MeshDistance distance(mesh);
  const internal::ClosedShells shells(mesh, distance);
  ASSERT_TRUE(shells.is_mesh_closed());
  const Vector3d origin = Vector3d::Zero();
  EXPECT_TRUE(shells.contain(origin));
  for (const Vector3d& d : along) {
    EXPECT_FALSE(shells.contain(1.8 * d));
    EXPECT_TRUE(shells.contain(3.5 * d));
  }
}

TEST(ClosedShells, AShellWithinAnotherThatTakesItAwayStillSealsItsHollow) {
  const TriangleMesh hollow =
      joined(cube_mesh(), inverted(box_mesh(Vector3d::Constant(0.25), Vector3d::Constant(0.75))));
  const MeshDistance distance(hollow);
  const internal::ClosedShells shells(hollow, distance);
  const Vector3d middle(0.5, 0.51, 0.52);
  EXPECT_NEAR(distance.winding_number(middle), 0.0, 1e-12);
  EXPECT_TRUE(shells.contain(middle));
  EXPECT_TRUE(shells.contain(Vector3d::Constant(0.1)));
  EXPECT_FALSE(shells.contain(Vector3d::Constant(1.1)));
}

TEST(ClosedShells, TrianglesOfOpenPartsAreLeftOut) {
  TriangleMesh open = cube_mesh();
  open.triangles.pop_back();
  const TriangleMesh mesh =
      joined(open, box_mesh(Vector3d::Constant(2.0), Vector3d::Constant(3.0)));
  const MeshDistance distance(mesh);
  const internal::ClosedShells shells(mesh, distance);
  EXPECT_FALSE(shells.is_mesh_closed());
  EXPECT_FALSE(shells.contain(Vector3d(0.5, 0.51, 0.52)));
  EXPECT_TRUE(shells.contain(Vector3d(2.5, 2.51, 2.52)));
}

}  // namespace
}  // namespace spherule::test
