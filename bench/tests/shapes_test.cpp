// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/shapes.h"

#include "base/error.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/solids.h"
#include "tests/support/turn_between.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spherule {
namespace {

using std::numbers::pi;

struct Case {
  std::string name;
  TriangleMesh mesh;
  std::size_t triangles;
  double volume;     // of the ideal solid
  double tolerance;  // relative; chords cut corners
};

std::vector<Case> cases() {
  return {
      {"box", make_box({1.0, 2.0, 3.0}), 12, 6.0, 1e-9},
      {"cube", make_cube(2.0), 12, 8.0, 1e-9},
      {"sphere", make_sphere(2.0, 64, 32), 2 * 64 * 31, 4.0 / 3.0 * pi * 8.0, 0.01},
      {"torus", make_torus(3.0, 1.0, 64, 32), 2 * 64 * 32, 2.0 * pi * pi * 3.0, 0.01},
      {"cylinder", make_cylinder(1.0, 4.0, 64), 4 * 64 - 4, 4.0 * pi, 0.01},
      {"cone", make_cone(1.0, 3.0, 64), 2 * 64 - 2, pi, 0.01},
      {"pipe", make_pipe(40.0, 34.0, 300.0, 81), 8 * 81, pi * (400.0 - 289.0) * 300.0, 0.01},
      {"l_bracket", make_l_bracket(10.0, 4.0, 1.0), 20, 4.0 * 19.0, 1e-9},
      {"plate", make_plate_with_holes({20.0, 12.0, 2.0}, 4, 3, 1.0, 32),
       // Each face has corners - 2 + 2 holes triangles; each side of a loop has two more.
       2 * (4 + 12 * 32 - 2 + 2 * 12) + 2 * (4 + 12 * 32), 2.0 * (240.0 - 12.0 * pi / 4.0), 0.01},
  };
}

TEST(Shapes, AreClosedAndFaceOutwards) {
  for (const Case& c : cases()) {
    EXPECT_EQ(c.mesh.triangles.size(), c.triangles) << c.name;
    EXPECT_TRUE(is_closed(c.mesh)) << c.name;
    EXPECT_NEAR(signed_volume(c.mesh) / c.volume, 1.0, c.tolerance) << c.name;
    EXPECT_EQ(component_points(c.mesh).size(), 1u) << c.name;
    for (const Eigen::Vector3d& vertex : c.mesh.vertices) EXPECT_TRUE(vertex.allFinite()) << c.name;
  }
}

TEST(Shapes, AMissingTriangleIsNoticed) {
  for (const Case& c : cases()) {
    TriangleMesh open = c.mesh;
    open.triangles.pop_back();
    EXPECT_FALSE(is_closed(open)) << c.name;
  }
}

TEST(Shapes, ThePipeHasItsMeasures) {
  const TriangleMesh pipe = make_pipe(40.0, 34.0, 300.0, 81);
  const Eigen::AlignedBox3d box = bounding_box(pipe);
  EXPECT_NEAR(box.max().x(), 20.0, 1e-12);
  EXPECT_DOUBLE_EQ(box.sizes().z(), 300.0);
  EXPECT_NEAR(winding_number(pipe, {18.5, 0.0, 0.0}), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(pipe, {0.0, 0.0, 0.0}), 0.0, 1e-9);
}

double area(const Loop& outer, const std::vector<Loop>& holes) {
  Loop points = outer;
  for (const Loop& hole : holes) points.insert(points.end(), hole.begin(), hole.end());
  double twice = 0.0;
  for (const Eigen::Vector3i& t : triangulate(outer, holes)) {
    const Eigen::Vector2d a = points[static_cast<std::size_t>(t[0])];
    const Eigen::Vector2d ab = points[static_cast<std::size_t>(t[1])] - a;
    const Eigen::Vector2d ac = points[static_cast<std::size_t>(t[2])] - a;
    const double cross = ab.x() * ac.y() - ab.y() * ac.x();
    EXPECT_GT(cross, 0.0);
    twice += cross;
  }
  return 0.5 * twice;
}

// All triangles face up and their areas add up: they neither overlap nor leave a hole uncut.
TEST(Polygon, TrianglesFillTheOutlineLessItsHoles) {
  const auto disc = [](double radius, int sides) {
    return 0.5 * sides * radius * radius * std::sin(2.0 * pi / sides);
  };
  const Loop outline = belt({0.0, 0.0}, 3.0, {8.0, 1.0}, 2.0, 10);
  const double whole = area(outline, {});
  std::vector<Loop> holes = screw_holes({0.0, 0.0}, 2.0, 8, 0.3, 6);
  EXPECT_NEAR(area(outline, holes), whole - 8 * disc(0.3, 6), 1e-6);
  holes.push_back(circle({0.0, 0.0}, 1.0, 24));
  holes.push_back(circle({8.0, 1.0}, 1.5, 7, 0.3));
  EXPECT_NEAR(area(outline, holes), whole - 8 * disc(0.3, 6) - disc(1.0, 24) - disc(1.5, 7), 1e-6);
  EXPECT_NEAR(area(rectangle({1.0, 2.0}, {4.0, 6.0}, 1.0, 16), {}), 24.0 - 4.0 + pi, 0.01);
}

TEST(Polygon, WrongLoopsAreRefused) {
  const Loop square = rectangle({0.0, 0.0}, {2.0, 2.0});
  EXPECT_THROW(triangulate({square.rbegin(), square.rend()}, {}), Error);
  EXPECT_THROW(triangulate(square, {circle({5.0, 0.0}, 0.5, 8)}), Error);
}

TEST(Solids, RefiningKeepsTheSolid) {
  TriangleMesh mesh = make_l_bracket(10.0, 4.0, 1.0);
  const double volume = signed_volume(mesh);
  refine_to(mesh, 500);
  EXPECT_EQ(mesh.triangles.size(), 500u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(signed_volume(mesh), volume, 1e-9);
  EXPECT_THROW(refine_to(mesh, 501), Error);
  EXPECT_THROW(refine_to(mesh, 498), Error);
  mesh.triangles.pop_back();
  EXPECT_THROW(refine_to(mesh, 1999), Error);
}

TEST(Solids, ATubeAlongAPathIsClosed) {
  const std::vector<Eigen::Vector3d> path{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 2, 1}};
  const TriangleMesh tube = tube_along(path, std::vector<double>{0.2, 0.2, 0.3, 0.1}, 12);
  EXPECT_TRUE(is_closed(tube));
  EXPECT_GT(signed_volume(tube), 0.0);
}

TEST(TurnBetween, TakesTheOneToTheOtherByTheSmallestTurn) {
  const Eigen::Vector3d from(0.3, -2.0, 0.5);
  for (const Eigen::Vector3d& to : std::vector<Eigen::Vector3d>{{4.0, 1.0, -0.2},
                                                                {0.3, -2.0, 0.5},
                                                                {-0.3, 2.0, -0.5},
                                                                {-0.3, 2.0, -1.0},
                                                                {2.0, 0.3, 0.0}}) {
    const Eigen::Quaterniond turn = turn_between(from, to);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-12) << to.transpose();
    EXPECT_NEAR(turn.norm(), 1.0, 1e-12);
    const double cosine = from.normalized().dot(to.normalized());
    EXPECT_NEAR(2.0 * turn.w() * turn.w() - 1.0, cosine, 1e-12) << to.transpose();
  }
}

}  // namespace
}  // namespace spherule
