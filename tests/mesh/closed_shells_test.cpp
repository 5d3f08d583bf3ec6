// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/shells.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

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

TEST(ClosedShells, TheNumberCountedAlongARayIsThatOfTheSolidAngles) {
  std::size_t inside = 0;
  for (const NamedMesh& named : mesh_zoo()) {
    SCOPED_TRACE(named.name);
    const MeshDistance distance(named.mesh);
    const internal::ClosedShells shells(named.mesh, distance);
    if (!shells.is_mesh_closed()) continue;
    for (const Vector3d& p : points_off(distance, static_cast<std::size_t>(effort(300, 30)))) {
      const int counted = shells.winding_number(p);
      ASSERT_EQ(counted, std::lround(distance.winding_number(p)));
      inside += counted != 0 ? 1 : 0;
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
  EXPECT_EQ(shells.winding_number(origin), std::lround(distance.winding_number(origin)));
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
  EXPECT_EQ(shells.winding_number(middle), 0);
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

// Work, not time: a ray intersects few of the boxes of a large mesh.
TEST(ClosedShells, ARayVisitsFewTriangles) {
  const TriangleMesh mesh = icosphere(effort(6, 4));
  const MeshDistance distance(mesh);
  std::size_t visited = 0;
  constexpr int kRays = 100;
  Random random(32);
  for (int i = 0; i < kRays; ++i) {
    const Vector3d p = 0.5 * random.direction();
    distance.visit_ray(p, Vector3d(0.4517, 0.6293, 0.6323), [&](const MeshDistance::Corners&) {
      ++visited;
      return true;
    });
  }
  EXPECT_GE(visited, std::size_t{kRays});
  EXPECT_LT(visited, std::size_t{40 * kRays});
}

}  // namespace
}  // namespace spherule::test
