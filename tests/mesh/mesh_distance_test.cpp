// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_distance.h"

#include "tests/mesh/distance_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

TriangleMesh placed(TriangleMesh mesh, double scale, const Vector3d& shift) {
  for (Vector3d& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

// In the box grown by half, on a vertex, or near the middle of a triangle.
Vector3d random_query(Random& random, const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
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
      const TriangleMesh mesh = placed(named.mesh, scale, shift);
      const MeshDistance distance(mesh);
      for (int i = 0; i < effort(40, 4); ++i) {
        const Vector3d p = random_query(random, mesh, distance.box());
        const SurfaceDistance d = distance(p);
        const Digits50 exact = exact_mesh_distance(p, mesh);
        ASSERT_LE(Digits50(d.lower), exact);
        ASSERT_GE(Digits50(d.upper), exact);
        const double size = distance.box().diagonal().norm() + p.norm();
        ASSERT_LE(d.upper - d.lower, 1e-5 * size);
        ASSERT_LE(exact_distance(d.closest, p), Digits50(d.upper + 1e-14 * size));
        const Eigen::Vector3i& t = mesh.triangles.at(static_cast<std::size_t>(d.triangle));
        const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
        ASSERT_LE(exact_triangle_distance(d.closest, vertex(0), vertex(1), vertex(2)),
                  Digits50(1e-14 * size));
      }
    }
  }
}

TEST(MeshDistance, TheIntervalIsNarrowForOrdinaryMeshes) {
  Random random(22);
  for (const TriangleMesh& mesh : {icosphere(2), l_bracket(), torus(1.0, 0.3, 24, 12)}) {
    const MeshDistance distance(mesh);
    const Eigen::AlignedBox3d box(Vector3d::Constant(-2), Vector3d::Constant(2));
    for (int i = 0; i < effort(1000, 200); ++i) {
      const SurfaceDistance d = distance(random.in_box(box));
      ASSERT_LE(d.upper - d.lower, 1e-14 * 8.0);
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
    const Vector3d p = random_query(random, mesh, distance.box());
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

TEST(MeshDistance, ATinyLimitClaimsNothingOfAPointOnTheSurface) {
  const MeshDistance distance(cube_mesh());
  for (const double limit : {1e-150, 1e-170, 1e-310, 0.0}) {
    const SurfaceDistance d = distance({0.5, 0.5, 1.0}, limit);
    EXPECT_EQ(d.lower, 0.0) << limit;
  }
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

TEST(MeshDistance, WindingNumberTellsInsideFromOutsideOfATorus) {
  Random random(24);
  const MeshDistance distance(torus(1.0, 0.3, 24, 12));
  for (int i = 0; i < effort(2000, 300); ++i) {
    const Vector3d p = random.in_box(distance.box());
    const double from_ring = std::hypot(std::hypot(p.x(), p.y()) - 1.0, p.z());
    const double winding = distance.winding_number(p);
    ASSERT_NEAR(winding, std::round(winding), 1e-9);
    if (from_ring < 0.27) {
      ASSERT_NEAR(winding, 1.0, 1e-9);
    } else if (from_ring > 0.3) {
      ASSERT_NEAR(winding, 0.0, 1e-9);
    }
  }
}

TEST(MeshDistance, TheBoxIsOfTheVerticesThatTrianglesUse) {
  TriangleMesh mesh = cube_mesh();
  mesh.vertices.emplace_back(100, 100, 100);
  const MeshDistance distance(mesh);
  EXPECT_EQ(distance.box().max(), Vector3d(1, 1, 1));
  EXPECT_EQ(distance.triangle_count(), 12U);
}

}  // namespace
}  // namespace spherule::test
