// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/convex_hull.h"

#include "base/error.h"
#include "bench/tests/baseline/hull_oracle.h"
#include "geometry/mesh_report.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

double extent_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box.diagonal().norm();
}

// What the header promises, judged exactly.
void expect_hull(const Points& points, const ConvexHull& hull, double most_expansion) {
  EXPECT_TRUE(is_sphere(hull.mesh));
  EXPECT_EQ(exact_outside(hull.mesh, points), 0U);
  EXPECT_GT(hull.expansion, 0.0);
  EXPECT_LE(hull.expansion, most_expansion * extent_of(points));
  // Convex up to the expansion: the vertices moved back lie inside.
  for (const Vector3d& v : hull.mesh.vertices) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : points) nearest = std::min(nearest, (p - v).norm());
    EXPECT_LE(nearest, hull.expansion);
  }
}

// Each vertex that triangles use once.
Points used_vertices(const TriangleMesh& mesh) {
  std::set<int> used;
  for (const Eigen::Vector3i& t : mesh.triangles) used.insert(t.begin(), t.end());
  Points points;
  for (const int v : used) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return points;
}

// A cube of points k/n on its faces: many on every plane and every edge.
Points grid_on_cube(int n) {
  Points points;
  for (int x = 0; x <= n; ++x) {
    for (int y = 0; y <= n; ++y) {
      for (int z = 0; z <= n; ++z) {
        const bool on_face = x % n == 0 || y % n == 0 || z % n == 0;
        if (on_face) points.push_back(Vector3d(x, y, z) / n);
      }
    }
  }
  return points;
}

TEST(ConvexHull, ContainsEveryVertexOfTheZoo) {
  int hulls = 0;
  for (const NamedMesh& named : mesh_zoo()) {
    SCOPED_TRACE(named.name);
    const Points points = used_vertices(named.mesh);
    if (points.size() > static_cast<std::size_t>(effort(400, 60)) || affine_dimension(points) < 3)
      continue;
    ++hulls;
    expect_hull(points, convex_hull(named.mesh), 1e-7);
  }
  EXPECT_GT(hulls, effort(8, 3));
}

TEST(ConvexHull, CoplanarAndCollinearPointsInAnyPositionAreHeld) {
  Random random(71);
  for (int i = 0; i < effort(12, 2); ++i) {
    SCOPED_TRACE(i);
    Points points = grid_on_cube(4);
    points.insert(points.end(), points.begin(), points.begin() + 20);  // duplicates
    const Eigen::Quaterniond turn = random.rotation();
    const double size = std::pow(10.0, random.between(-6, 6));
    const Vector3d shift =
        i % 2 == 0 ? Vector3d::Zero() : Vector3d(100.0 * size * random.direction());
    for (Vector3d& p : points) p = size * (turn * p) + shift;
    const ConvexHull hull = convex_hull(points, {}, "grid");
    expect_hull(points, hull, 1e-9);
    const double volume = mesh_report(hull.mesh, {}).volume;
    EXPECT_NEAR(volume / (size * size * size), 1.0, 1e-8);
  }
}

TEST(ConvexHull, NearlyFlatAndLongPointsAreHeld) {
  Random random(72);
  for (const double thickness : {1e-2, 1e-4, 1e-6}) {
    for (const double width : {1.0, 1e-3}) {
      SCOPED_TRACE(testing::Message() << thickness << " " << width);
      const Eigen::Quaterniond turn = random.rotation();
      Points points;
      for (int i = 0; i < 60; ++i) {
        points.push_back(turn * Vector3d(random.unit(), width * random.unit(),
                                         width * thickness * random.unit()));
      }
      // Thinner than this, growing it would move its far ends by more than is allowed: it may be
      // refused, but not answered wrongly.
      try {
        expect_hull(points, convex_hull(points, {}, "slab"), 1e-6);
      } catch (const Error&) {
        EXPECT_LE(width * thickness, 1.1e-5);
      }
    }
  }
}

TEST(ConvexHull, VolumesOfKnownHulls) {
  EXPECT_NEAR(mesh_report(convex_hull(cube_mesh(2.0)).mesh, {}).volume, 8.0, 1e-10);
  EXPECT_NEAR(mesh_report(convex_hull(open_box()).mesh, {}).volume,
              mesh_report(convex_hull(inverted(open_box())).mesh, {}).volume, 1e-12);
  // Prism over a regular polygon of 16 sides.
  const double area = 8.0 * std::sin(std::acos(-1.0) / 8.0);
  EXPECT_NEAR(mesh_report(convex_hull(pipe(1.0, 0.5, 3.0, 16)).mesh, {}).volume, 3.0 * area, 1e-9);
}

TEST(ConvexHull, PaddingAndVertexErrorAreInside) {
  TriangleMesh mesh = l_bracket();
  mesh.vertex_error = 0.001;
  const ConvexHull hull = convex_hull(mesh, {.padding = 0.002});
  Random random(73);
  Points spheres;
  for (const Vector3d& p : used_vertices(mesh)) {
    for (int i = 0; i < 8; ++i) spheres.push_back(p + 0.003 * random.direction());
  }
  EXPECT_EQ(exact_outside(hull.mesh, spheres), 0U);
  EXPECT_GE(exact_outside(convex_hull(l_bracket()).mesh, spheres), 1U);  // so it was needed
  EXPECT_LE(hull.expansion, 0.05);
}

TEST(ConvexHull, FlatInputIsRefusedWithItsReason) {
  const auto reason = [](const Points& points) -> std::string {
    try {
      convex_hull(points, {}, "points");
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const Vector3d a(1, 2, 3), b(4, 4, 4), c(0, 1, 8);
  EXPECT_NE(reason({a, a, a}).find("coincide"), std::string::npos);
  EXPECT_NE(reason({a, b, 0.5 * (a + b)}).find("on a line"), std::string::npos);
  EXPECT_NE(reason({a, b, c, 0.5 * (a + b)}).find("in a plane"), std::string::npos);
  EXPECT_NE(reason({}).find("no vertices"), std::string::npos);
  EXPECT_THROW(convex_hull(cube_mesh(), {.padding = -1.0}), Error);
  EXPECT_THROW(convex_hull(cube_mesh(), {.padding = std::nan("")}), Error);
  EXPECT_THROW(convex_hull(TriangleMesh{}), Error);
}

TEST(ConvexHull, PolygonsAreListedWithTheirNumberOfCorners) {
  TriangleMesh mesh;
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  EXPECT_EQ(polygon_list(mesh), (std::vector<int>{3, 0, 1, 2, 3, 2, 1, 3}));
}

}  // namespace
}  // namespace spherule::test
