// SPDX-License-Identifier: BSD-3-Clause
#include "io/polygon_triangles.h"

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;
using Polygon = std::vector<Vector2d>;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double area_of(const Polygon& polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    area += cross(polygon[i], polygon[(i + 1) % polygon.size()]) / 2.0;
  }
  return area;
}

// How often it is around the point: crossings of a ray, each with its direction.
int winding(const Polygon& polygon, const Vector2d& p) {
  int number = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    const double side = cross(b - a, p - a);
    if (a.y() <= p.y() && side > 0.0) ++number;
    if (b.y() <= p.y() && side < 0.0) --number;
  }
  return number;
}

// The polygon divided in a plane of space, as polygons in its own plane.
std::vector<Polygon> divided(const Polygon& polygon, Random& random) {
  Eigen::Quaterniond turn(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                          random.between(-1, 1));
  turn.normalize();
  std::vector<Vector3d> vertices;
  for (const Vector2d& p : polygon) vertices.push_back(turn * Vector3d(p.x(), p.y(), 3.0));
  std::vector<int> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0);
  const auto triangles = internal::polygon_triangles(vertices, corners);
  std::vector<Polygon> result;
  if (!triangles) return result;
  for (const Vector3i& t : *triangles) {
    Polygon& triangle = result.emplace_back();
    for (const int corner : t) triangle.push_back(polygon[static_cast<std::size_t>(corner)]);
  }
  return result;
}

// Points within are in one triangle, points outside in none, and none is turned over.
void expect_exact(const Polygon& polygon, Random& random, const std::string& what) {
  const std::vector<Polygon> triangles = divided(polygon, random);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << what;
  for (const Polygon& triangle : triangles) ASSERT_GE(area_of(triangle), -1e-9) << what;
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : polygon) box.extend(p);
  for (int i = 0; i < effort(200, 20); ++i) {
    const Vector2d p(random.between(box.min().x(), box.max().x()),
                     random.between(box.min().y(), box.max().y()));
    const auto holds = std::ranges::count_if(
        triangles, [&](const Polygon& triangle) { return winding(triangle, p) != 0; });
    ASSERT_EQ(holds, winding(polygon, p)) << what;
  }
}

// Other corners come first, too.
void expect_exact_from_all(Polygon polygon, Random& random, const std::string& what) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    expect_exact(polygon, random, what + " from " + std::to_string(i));
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
}

// Around the origin, at random distances from it.
Polygon star(Random& random, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random.between(0.1, 0.9)) / corners;
    polygon.push_back(random.between(0.1, 1.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

// With teeth of a length as wide as all of them together, leaning.
Polygon comb(int teeth, double lean) {
  Polygon polygon{{0.0, -1.0}, {2.0 * teeth, -1.0}};
  for (int i = teeth - 1; i >= 0; --i) {
    const Vector2d root(2.0 * i, 0.0);
    const Vector2d tip = root + Vector2d(lean * 2.0 * teeth, 2.0 * teeth);
    polygon.insert(polygon.end(), {root + Vector2d(1.5, 0), tip + Vector2d(1, 0), tip, root});
  }
  return polygon;
}

// A square with square holes in a row, each tied to the one before it by a bridge.
Polygon plate(int holes) {
  Polygon polygon{{0, 0}, {4.0 * holes, 0}, {4.0 * holes, 4}, {0, 4}, {0, 0}};
  std::vector<Vector2d> back;
  for (int i = 0; i < holes; ++i) {
    const Vector2d at(4.0 * i + 1.0, 1.0);
    polygon.push_back(at);
    polygon.push_back(at + Vector2d(0, 2));
    polygon.push_back(at + Vector2d(2, 2));
    polygon.push_back(at + Vector2d(2, 0));
    back.push_back(at);
  }
  polygon.insert(polygon.end(), back.rbegin(), back.rend());
  return polygon;
}

TEST(PolygonTriangles, AConvexOneIsAFan) {
  Random random(1);
  Polygon polygon;
  for (int i = 0; i < 12; ++i) polygon.emplace_back(std::cos(i / 2.0), std::sin(i / 2.0));
  const std::vector<Polygon> triangles = divided(polygon, random);
  ASSERT_EQ(triangles.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(triangles[i], (Polygon{polygon[0], polygon[i + 1], polygon[i + 2]}));
  }
}

TEST(PolygonTriangles, AreThePolygon) {
  Random random(2);
  for (int i = 0; i < effort(200, 20); ++i) {
    const int corners = 4 + static_cast<int>(random.index(40));
    expect_exact(star(random, corners), random, "star " + std::to_string(i));
  }
  expect_exact_from_all({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, random, "L");
  expect_exact_from_all({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, random,
                        "U");
  expect_exact_from_all({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {1, 1}, {0, 2}, {0, 1}}, random,
                        "with corners on lines and twice");
  expect_exact_from_all(comb(6, 0.0), random, "comb");
  expect_exact_from_all(comb(6, 0.7), random, "leaning comb");
  for (const int holes : {1, 2, 5}) expect_exact_from_all(plate(holes), random, "plate");
}

TEST(PolygonTriangles, OneThatCrossesItselfStaysAFan) {
  Random random(3);
  const Polygon bow{{0, 0}, {3, 2}, {3, 0}, {0, 1}};
  const std::vector<Polygon> triangles = divided(bow, random);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_EQ(triangles[0], (Polygon{bow[0], bow[1], bow[2]}));
}

TEST(PolygonTriangles, ManyCorners) {
  Random random(4);
  // An L, and from its end there and back a line.
  Polygon spike{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}};
  const int half = effort(20000, 2000);
  for (int i = 1; i <= half; ++i) spike.emplace_back(1.0, 2.0 + i);
  for (int i = half; i-- > 1;) spike.emplace_back(1.0, 2.0 + i);
  spike.insert(spike.end(), {{1, 2}, {0, 2}});
  EXPECT_EQ(divided(spike, random).size(), spike.size() - 2);
  EXPECT_EQ(divided(comb(1000, 0.0), random).size(), 4000u);
  EXPECT_EQ(divided(star(random, 3000), random).size(), 2998u);
  if (kSanitized) return;
  EXPECT_TRUE(divided(comb(10000, 1.0), random).empty());
}

// A plate with a hole through it, its top and bottom a face each, is as thick and as open as it is
// when it is divided by hand.
TEST(PolygonTriangles, AFileOfPolygonsIsThePart) {
  const Polygon top{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0},
                    {4, 4}, {4, 6},  {6, 6},   {6, 4},  {4, 4}};
  std::ostringstream obj;
  for (const int z : {0, 1}) {
    for (const std::size_t i : std::vector<std::size_t>{0, 1, 2, 3, 5, 6, 7, 8}) {
      obj << "v " << top[i].x() << ' ' << top[i].y() << ' ' << z << '\n';
    }
  }
  obj << "f 9 10 11 12 9 13 14 15 16 13\nf 5 8 7 6 5 1 4 3 2 1\n";
  for (const int first : {1, 5}) {
    for (int i = 0; i < 4; ++i) {
      const int a = first + i, b = first + (i + 1) % 4;
      obj << "f " << a << ' ' << b << ' ' << b + 8 << ' ' << a + 8 << '\n';
    }
  }
  const TempDir folder;
  const MeshReport report = mesh_report(read_mesh(folder.write("plate.obj", obj.str())));
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 96.0, 1e-9);
  EXPECT_NEAR(report.area, 2 * 96.0 + 40.0 + 8.0, 1e-9);
  EXPECT_EQ(report.self_intersections, 0u);
}

}  // namespace
}  // namespace spherule::test
