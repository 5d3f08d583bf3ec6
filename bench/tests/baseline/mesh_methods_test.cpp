// SPDX-License-Identifier: BSD-3-Clause
// Meshes that methods of comparison make: hulls and decompositions by exact oracles, decimation,
// and how far a mesh is measured to be from another.
#include "bench/baseline/mesh_methods.h"

#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"
#include "tests/support/solids.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Exact oracles of hulls; they share no code with the library.

using ExactPoint = std::array<Rational, 3>;

ExactPoint exact(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

// The determinant of b - a, c - a, p - a and, as the sum of its terms without their signs, what its
// rounding is a share of.
template <class Number>
std::array<Number, 2> determinant_and_size(const std::array<Number, 3>& a,
                                           const std::array<Number, 3>& b,
                                           const std::array<Number, 3>& c,
                                           const std::array<Number, 3>& p) {
  std::array<std::array<Number, 3>, 3> d;
  for (std::size_t k = 0; k < 3; ++k) {
    d[0][k] = b[k] - a[k];
    d[1][k] = c[k] - a[k];
    d[2][k] = p[k] - a[k];
  }
  std::array<Number, 2> sums{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Number plus = d[0][k] * d[1][(k + 1) % 3] * d[2][(k + 2) % 3];
    const Number minus = d[0][k] * d[1][(k + 2) % 3] * d[2][(k + 1) % 3];
    sums[0] += plus - minus;
    sums[1] += plus < 0 ? -plus : plus;
    sums[1] += minus < 0 ? -minus : minus;
  }
  return sums;
}

// Sign of the determinant: positive if p lies beyond the triangle's outer side. In long double
// where that is clear: five roundings a product of differences, three of the sum, 2^-64 each.
int exact_side(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  using Rough = std::array<long double, 3>;
  const auto rough = [](const Eigen::Vector3d& v) { return Rough{v.x(), v.y(), v.z()}; };
  const auto [value, size] = determinant_and_size(rough(t[0]), rough(t[1]), rough(t[2]), rough(p));
  if (std::abs(value) > 0x1p-58L * size) return value > 0.0L ? 1 : -1;
  return determinant_and_size(exact(t[0]), exact(t[1]), exact(t[2]), exact(p))[0].sign();
}

// How many pairs of a triangle and a point have the point beyond the triangle's plane or on it.
std::size_t exact_outside(const TriangleMesh& hull, std::span<const Eigen::Vector3d> points) {
  std::size_t count = 0;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const auto corner = [&](int k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
    const std::array<Eigen::Vector3d, 3> triangle{corner(0), corner(1), corner(2)};
    for (const Eigen::Vector3d& p : points) count += exact_side(triangle, p) >= 0 ? 1 : 0;
  }
  return count;
}

// Every edge is used once in either direction, and Euler's formula holds for one sphere.
bool is_sphere(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  std::set<int> used;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      used.insert(t[k]);
      if (!edges.emplace(t[k], t[(k + 1) % 3]).second) return false;
    }
  }
  for (const auto& [from, to] : edges) {
    if (!edges.contains({to, from})) return false;
  }
  return used.size() == mesh.vertices.size() &&
         used.size() + mesh.triangles.size() == edges.size() / 2 + 2;
}

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

// Exactly: the three corners of the triangle lie in the hull, so all of it does.
bool part_holds(const TriangleMesh& part, const TriangleMesh& mesh,
                const Eigen::Vector3i& triangle) {
  std::vector<Eigen::Vector3d> corners;
  for (const int v : triangle) corners.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return exact_outside(part, corners) == 0;
}

void expect_parts(const TriangleMesh& mesh, const ConvexDecomposition& result) {
  for (const TriangleMesh& part : result.parts) {
    EXPECT_TRUE(is_sphere(part));
    EXPECT_GT(mesh_report(part, {.self_intersections = false}).volume, 0.0);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    EXPECT_TRUE(std::any_of(result.parts.begin(), result.parts.end(),
                            [&](const TriangleMesh& part) { return part_holds(part, mesh, t); }));
  }
}

TEST(ConvexDecomposition, EveryTriangleLiesInAPart) {
  for (const char* name :
       effort(std::vector{"l-bracket", "open-box", "cube", "pipe", "three-fins", "nested-shells"},
              2)) {
    SCOPED_TRACE(name);
    for (const NamedMesh& named : mesh_zoo()) {
      if (named.name != name || named.mesh.triangles.size() > 200) continue;
      ConvexDecompositionOptions options;
      options.measure.reset();
      expect_parts(named.mesh, decompose(named.mesh, options));
    }
  }
}

TEST(ConvexDecomposition, TheBendOfABracketStaysFree) {
  const TriangleMesh bracket = l_bracket();
  const ConvexDecomposition fine = decompose(bracket, {.max_concavity = 0.01});
  expect_parts(bracket, fine);
  EXPECT_GE(fine.parts.size(), 2U);
  EXPECT_LE(fine.deviation.loss.upper, 0.01);
  // Joined to one part it is the hull, which fills the bend.
  const ConvexDecomposition one = decompose(bracket, {.max_concavity = 10.0});
  EXPECT_EQ(one.parts.size(), 1U);
  EXPECT_GT(one.deviation.excess.lower, 0.2);
  EXPECT_LT(fine.deviation.excess.upper, one.deviation.excess.lower);
  EXPECT_NEAR(one.volume, mesh_report(one.parts.front(), {}).volume, 1e-12);
}

TEST(ConvexDecomposition, DegenerateTrianglesAndDuplicatesAreHeldToo) {
  for (const TriangleMesh& mesh :
       {with_degenerates(cube_mesh()), with_duplicates(l_bracket()), soup(12, 5)}) {
    expect_parts(mesh, decompose(mesh, {.measure = std::nullopt}));
  }
}

TEST(ConvexDecomposition, AFlatMeshBecomesAPlate) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const ConvexDecomposition result = decompose(sheet);
  expect_parts(sheet, result);
  EXPECT_LE(result.deviation.excess.upper, 3e-3);
}

TEST(ConvexDecomposition, EqualInputGivesEqualParts) {
  const TriangleMesh mesh = torus(1.0, 0.3, 16, 8);
  const ConvexDecomposition a = decompose(mesh, {.measure = std::nullopt});
  const ConvexDecomposition b = decompose(mesh, {.measure = std::nullopt});
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].vertices, b.parts[i].vertices);
    EXPECT_EQ(a.parts[i].triangles, b.parts[i].triangles);
  }
}

TEST(ConvexDecomposition, BadInputIsRefused) {
  EXPECT_THROW(decompose(TriangleMesh{}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.max_concavity = -1.0}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.max_concavity = std::nan("")}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.min_parts = 0}), Error);
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(decompose(line), Error);
}

TEST(Decimation, ReachesTheTargetWithVerticesOfTheOriginal) {
  const TriangleMesh mesh = torus(1.0, 0.3, 40, 20);
  const Decimation half = decimate(mesh, {.target_triangles = mesh.triangles.size() / 2});
  EXPECT_LE(half.mesh.triangles.size(), mesh.triangles.size() / 2);
  EXPECT_GE(half.mesh.triangles.size(), mesh.triangles.size() / 2 - 4);
  for (const Eigen::Vector3d& v : half.mesh.vertices) {
    EXPECT_GE(std::count(mesh.vertices.begin(), mesh.vertices.end(), v), 1);
  }
  EXPECT_GT(half.estimated_error, 0.0);
  EXPECT_GT(half.deviation.loss.lower, 0.0);  // a bulge was cut off: not conservative
  EXPECT_LE(half.deviation.loss.upper, 0.05);
  EXPECT_LE(half.deviation.excess.upper, 0.05);
  const double ratio = mesh_report(half.mesh, {}).volume / mesh_report(mesh, {}).volume;
  EXPECT_NEAR(ratio, 1.0, 0.03);
}

TEST(Decimation, ClosedMeshesStayClosed) {
  int closed = 0;
  for (const NamedMesh& named : mesh_zoo()) {
    if (!mesh_report(named.mesh, {.self_intersections = false}).closed) continue;
    // Of few triangles nothing may be left, which is an Error.
    if (named.mesh.triangles.size() < 100) continue;
    for (const std::size_t divisor : {2U, 5U, 20U}) {
      SCOPED_TRACE(testing::Message() << named.name << " / " << divisor);
      DecimationOptions options;
      options.target_triangles = std::max<std::size_t>(4, named.mesh.triangles.size() / divisor);
      options.measure.reset();
      const Decimation result = decimate(named.mesh, options);
      EXPECT_TRUE(mesh_report(result.mesh, {.self_intersections = false}).closed);
      ++closed;
    }
  }
  EXPECT_GT(closed, 8);
}

TEST(Decimation, WhatIsFlatCostsNothingAndIsMeasuredAsSuch) {
  // A box of many coplanar triangles comes down to few without any loss.
  TriangleMesh fine = cube_mesh();
  refine_to(fine, 768);
  const Decimation result = decimate(fine, {.max_error = 1e-4});
  EXPECT_LE(result.mesh.triangles.size(), 60U);
  EXPECT_LE(result.estimated_error, 1e-4);
  EXPECT_LE(result.deviation.loss.lower, 1e-12);
  EXPECT_LE(result.deviation.loss.upper, 2e-3);
  EXPECT_NEAR(mesh_report(result.mesh, {}).volume, 1.0, 1e-12);
}

TEST(Decimation, ASmallerErrorKeepsMoreTriangles) {
  std::size_t before = 0;
  for (const double error : {0.1, 0.01, 0.001, 0.0}) {
    const Decimation result = decimate(icosphere(3), {.max_error = error, .measure = std::nullopt});
    EXPECT_LE(result.estimated_error, error * 1.0001);
    EXPECT_GE(result.mesh.triangles.size(), before);
    before = result.mesh.triangles.size();
  }
  EXPECT_GE(before, 1000U);
}

TEST(Decimation, BadInputIsRefused) {
  EXPECT_THROW(decimate(TriangleMesh{}, {}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.target_triangles = 0}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.max_error = -1.0}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.max_error = std::nan("")}), Error);
  TriangleMesh point;
  point.vertices.assign(3, Eigen::Vector3d::Ones());
  point.triangles.emplace_back(0, 1, 2);
  EXPECT_THROW(decimate(point, {}), Error);
}

void expect_holds(const Bounds& bounds, double exact, double tolerance) {
  EXPECT_LE(bounds.lower, exact + 1e-12);
  EXPECT_GE(bounds.upper, exact - 1e-12);
  EXPECT_LE(bounds.upper - bounds.lower, tolerance + 1e-12);
}

TEST(MeshDeviation, AMeshDoesNotDeviateFromItself) {
  for (const TriangleMesh& mesh : {cube_mesh(), torus(1.0, 0.3, 16, 8), open_box()}) {
    const MeshDeviation d = measure_deviation(mesh, mesh);
    expect_holds(d.loss, 0.0, 1e-3 * 4.0);
    expect_holds(d.excess, 0.0, 1e-3 * 4.0);
  }
}

TEST(MeshDeviation, BoxesWithKnownDistances) {
  const TriangleMesh small = box_mesh({0, 0, 0}, {1, 1, 1});
  const TriangleMesh large = box_mesh({-1, -2, -2}, {1, 1, 1});
  const double tolerance = 1e-3 * large.vertices.front().norm() * 4.0;
  const MeshDeviation d = measure_deviation(small, large);
  expect_holds(d.loss, 0.0, tolerance);
  expect_holds(d.excess, 3.0, tolerance);  // from (-1, -2, -2) to the origin
  const MeshDeviation back = measure_deviation(large, small);
  expect_holds(back.loss, 3.0, tolerance);
  expect_holds(back.excess, 0.0, tolerance);
}

// The farthest point stands inside a triangle, at no vertex.
TEST(MeshDeviation, AFarthestPointInsideATriangleIsFound) {
  // Two boxes at the ends of a longer one: its middle is farthest from both.
  const TriangleMesh bar = box_mesh({0, 0, 0}, {10, 1, 1});
  const TriangleMesh ends = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({9, 0, 0}, {10, 1, 1}));
  const MeshDeviation d = measure_deviation(bar, ends);
  expect_holds(d.loss, 4.0, 1e-3 * 11.0);
  expect_holds(d.excess, 0.0, 1e-3 * 11.0);
}

// An open original has no inside to hide in.
TEST(MeshDeviation, OnlyClosedMeshesHaveAnInside) {
  const TriangleMesh inner = box_mesh({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  expect_holds(measure_deviation(inner, cube_mesh()).loss, 0.0, 1e-3 * 2.0);
  const MeshDeviation d = measure_deviation(inner, open_box());
  EXPECT_GT(d.loss.lower, 0.05);
}

TEST(MeshDeviation, NoSampleIsFartherThanTheBound) {
  Random random(81);
  const TriangleMesh mesh = torus(1.0, 0.4, 14, 9);
  const TriangleMesh other =
      moved(icosphere(1), Eigen::Isometry3d(Eigen::Translation3d(0.7, 0, 0)));
  const MeshDeviation d = measure_deviation(mesh, other);
  EXPECT_LE(d.loss.upper - d.loss.lower, 1e-3 * 5.0);
  double farthest = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
    double u = random.unit(), v = random.unit();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Vector3d p = corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
    if ((p - Vector3d(0.7, 0, 0)).norm() < 1.0) continue;  // inside, or less than 0.1 away
    farthest = std::max(farthest, static_cast<double>(exact_mesh_distance(p, other)));
  }
  EXPECT_LE(farthest, d.loss.upper + 1e-12);
  EXPECT_GE(farthest, 0.8 * d.loss.lower);  // the samples are not far from the truth
}

TEST(MeshDeviation, ALimitOfPiecesLeavesHonestBounds) {
  const TriangleMesh bar = box_mesh({0, 0, 0}, {10, 1, 1});
  const TriangleMesh ends = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({9, 0, 0}, {10, 1, 1}));
  const MeshDeviation d = measure_deviation(bar, ends, {.tolerance = 1e-5, .most_pieces = 40});
  EXPECT_LE(d.loss.lower, 4.0);
  EXPECT_GE(d.loss.upper, 4.0);
  EXPECT_GT(d.loss.upper - d.loss.lower, 1e-3);
}

TEST(MeshDeviation, BadInputIsRefused) {
  EXPECT_THROW(measure_deviation(TriangleMesh{}, cube_mesh()), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), TriangleMesh{}), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), cube_mesh(), {.tolerance = 0.0}), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), cube_mesh(), {.tolerance = std::nan("")}), Error);
}

}  // namespace
}  // namespace spherule::test
