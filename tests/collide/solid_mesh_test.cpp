// SPDX-License-Identifier: BSD-3-Clause
// Meshes with their inside: rays in rational numbers, shells of all kinds against winding numbers
// from solid angles, and what rounding cannot tell.
#include "collide/meshes/solid_mesh.h"

#include "base/error.h"
#include "collide/meshes/mesh_inside.h"
#include "collide/search/relative_pose.h"
#include "collide/shapes.h"
#include "geometry/ray.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::kRayDirections;
using internal::MeshInside;
using internal::Ray;
using internal::Triangle;

int sign(const Rational& x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// Nothing if the ray from the point intersects the triangle's boundary, or the point is in its
// plane where the line passes through it.
std::optional<int> exact_crossing(const Vector<Rational>& point, const Vector3d& direction,
                                  const Triangle& triangle) {
  std::array<Vector<Rational>, 3> t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = difference(exact<Rational>(triangle[k]), point);
  const Vector<Rational> w = exact<Rational>(direction);
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = sign(dot(w, cross(t[k], t[(k + 1) % 3])));
    positive += side > 0;
    negative += side < 0;
  }
  if (positive > 0 && negative > 0) return 0;
  const int ahead = sign(dot(t[0], cross(t[1], t[2])));
  if (positive == 3 || negative == 3) {
    const int turn = positive == 3 ? 1 : -1;
    if (ahead == 0) return std::nullopt;
    return ahead == turn ? turn : 0;
  }
  for (const Vector<Rational>& corner : t) {
    if (dot(w, corner) >= 0) return std::nullopt;
  }
  return 0;
}

TEST(Ray, DecidesForEveryPointWithinTheError) {
  Random random(1);
  int through = 0, by = 0, uncertain = 0;
  for (int i = 0; i < 6000; ++i) {
    Triangle t = {random.point(1.0), random.point(1.0), random.point(1.0)};
    if (random.whole(0, 9) == 0) t[2] = t[0] + random.between(0.0, 1.0) * (t[1] - t[0]);
    const Vector3d direction = random.whole(0, 1) == 0
                                   ? kRayDirections[static_cast<std::size_t>(random.whole(0, 7))]
                                   : Vector3d::Unit(random.whole(0, 2));
    const double v = random.whole(0, 1) * random.between(0.0, 1.0);
    const double w = random.whole(0, 1) * random.between(0.0, 1.0 - v);
    constexpr double kErrors[] = {0.0, 1e-15, 1e-12, 1e-6};
    const double error = kErrors[random.whole(0, 3)];
    const double near = kErrors[random.whole(0, 3)];
    const Vector3d target = t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]) + near * random.point(1.0);
    const Vector3d point = target - random.whole(-1, 3) * random.between(0.0, 1.0) * direction;
    const Vector3d offset = 0.999 * error * random.point(1.0).normalized();
    Vector<Rational> off = exact<Rational>(point);
    for (int k = 0; k < 3; ++k) off[static_cast<std::size_t>(k)] += Rational(offset[k]);

    const std::optional<int> found = Ray(point, error, direction).crossing(t);
    const std::optional<int> truth = exact_crossing(off, direction, t);
    if (found) {
      ASSERT_EQ(found, truth) << i;
    }
    through += found && *found != 0;
    by += found && *found == 0;
    uncertain += !found;
  }
  EXPECT_GT(through, 500);
  EXPECT_GT(by, 500);
  EXPECT_GT(uncertain, 500);
}

TEST(Ray, KeepsTheSpheresItIntersects) {
  Random random(2);
  int met = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d direction = Vector3d::Unit(random.whole(0, 2));
    const Vector3d point = random.point(1.0);
    // A sphere that the ray touches, up to rounding, from within or without, or starts behind.
    const double along = random.between(-0.5, 1.0);
    const Vector3d foot = point + along * direction;
    const Vector3d aside = random.point(1.0).cross(direction);
    const double change = 1.0 + random.whole(-3, 3) * 0x1p-51;
    const Sphere sphere{foot + aside, aside.norm() * change};
    Vector<Real> nearest = exact<Real>(point);
    const Vector<Real> to = difference(exact<Real>(sphere.center), nearest);
    const Vector<Real> w = exact<Real>(direction);
    Real t = dot(to, w) / dot(w, w);
    if (t < 0) t = 0;
    const Real square = squared_distance(plus(nearest, t, w), exact<Real>(sphere.center));
    const bool intersects = square <= Real(sphere.radius) * Real(sphere.radius);
    ASSERT_TRUE(!intersects || Ray(point, 0.0, direction).may_intersect(sphere)) << i;
    met += intersects;
    missed += !Ray(point, 0.0, direction).may_intersect({sphere.center, 0.9 * sphere.radius});
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 2000);
}

// Both ends of a double pyramid about the origin stand on the rays in `direction`.
TriangleMesh double_pyramid(const Vector3d& direction, int sides) {
  const Vector3d x = direction.unitOrthogonal(), y = direction.cross(x).normalized();
  TriangleMesh mesh{{direction, -direction}, {}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const int next = 2 + (i + 1) % sides;
    mesh.vertices.push_back(std::cos(angle) * x + std::sin(angle) * y);
    mesh.triangles.emplace_back(0, 2 + i, next);
    mesh.triangles.emplace_back(1, next, 2 + i);
  }
  return mesh;
}

TEST(MeshInside, TakesAnotherRayWhereOneMeetsACorner) {
  for (const Vector3d& direction : kRayDirections) {
    for (const int sides : {3, 4, 5, 12}) {
      const TriangleMesh mesh = double_pyramid(direction, sides);
      const MeshInside inside(mesh);
      const MeshTree tree(mesh);
      ASSERT_TRUE(inside.is_closed());
      ASSERT_EQ(component_points(mesh).size(), 1u);
      for (const double error : {0.0, 1e-12, 1e-3}) {
        EXPECT_TRUE(inside.contains(tree, Vector3d::Zero(), error));
        EXPECT_TRUE(inside.contains(tree, 0.4 * direction, error));
        EXPECT_FALSE(inside.contains(tree, -1.1 * direction, error));
        EXPECT_FALSE(inside.contains(tree, 1.1 * direction, error));
        EXPECT_FALSE(inside.contains(tree, 3.0 * direction.unitOrthogonal(), error));
      }
      // Near the surface, on whichever side, it says yes.
      EXPECT_TRUE(inside.contains(tree, (1.0 + 1e-7) * direction, 1e-6));
      EXPECT_TRUE(inside.contains(tree, direction, 0.0));
    }
  }
}

TEST(MeshInside, OpenComponentsDoNotCount) {
  TriangleMesh mesh = double_pyramid(kRayDirections[1], 5);
  const auto first = static_cast<int>(mesh.vertices.size());
  const Vector3d x = kRayDirections[0].unitOrthogonal(), y = kRayDirections[0].cross(x);
  // A flap that the first ray passes through, within the pyramid.
  const Vector3d middle = 0.05 * kRayDirections[0];
  mesh.vertices.insert(mesh.vertices.end(),
                       {middle + 0.1 * x, middle - 0.1 * x + 0.1 * y, middle - 0.1 * x - 0.1 * y});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  for (int turned = 0; turned < 2; ++turned) {
    const MeshInside inside(mesh);
    EXPECT_TRUE(inside.has_inside());
    EXPECT_FALSE(inside.is_closed());
    EXPECT_EQ(component_points(mesh).size(), 2u);
    EXPECT_TRUE(inside.contains(MeshTree(mesh), Vector3d::Zero(), 0.0));
    EXPECT_FALSE(inside.contains(MeshTree(mesh), -1.2 * kRayDirections[0], 0.0));
    // So that one of both ways round the flap would take away what the pyramid adds.
    mesh.triangles.pop_back();
    std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
  }
}

// --- shells of all kinds ---

TriangleMesh double_sided(const TriangleMesh& mesh) {
  return joined(mesh, inverted(mesh));
}

TriangleMesh without_last(TriangleMesh mesh) {
  mesh.triangles.pop_back();
  return mesh;
}

TriangleMesh randomly_turned(TriangleMesh mesh, unsigned seed) {
  Random random(seed);
  for (Eigen::Vector3i& t : mesh.triangles) {
    if (random.coin()) std::swap(t[0], t[1]);
  }
  return mesh;
}

double distance_to_surface(const TriangleMesh& mesh, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto triangle = placed<double>(Pose(), corners_of(mesh, i));
    least = std::min(least, squared_distance_to_triangle(exact<double>(p), triangle));
  }
  return std::sqrt(least);
}

// A mesh, and parts that are closed each; what one of them encloses is inside.
struct Shell {
  Shell(std::string shell = {}, std::vector<TriangleMesh> closed = {}, bool any_turn = true)
      : name(std::move(shell)), parts(std::move(closed)), has_any_turn(any_turn) {
    for (const TriangleMesh& part : parts) mesh = joined(mesh, part);
  }
  bool encloses(const Vector3d& p) const {
    return std::any_of(parts.begin(), parts.end(), [&](const TriangleMesh& part) {
      return std::abs(winding_number(part, p)) > 0.5;
    });
  }

  std::string name;
  std::vector<TriangleMesh> parts;
  // Whether the turns of its triangles do not matter: no two are alike, nor an edge of two parts.
  bool has_any_turn;
  TriangleMesh mesh{};
};

// Of unit cubes, four walls to an edge; each wall is drawn once, by the first of the two.
Shell rooms(int x, int y, int z) {
  std::vector<TriangleMesh> boxes;
  TriangleMesh walls;
  for (int i = 0; i < x * y * z; ++i) {
    const Vector3d low(i % x, i / x % y, i / x / y);
    boxes.push_back(box_mesh(low, low + Vector3d::Ones()));
    TriangleMesh room = boxes.back();
    std::erase_if(room.triangles, [&](const Eigen::Vector3i& t) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto is_on_wall = [&](int v) {
          return room.vertices[static_cast<std::size_t>(v)][axis] == low[axis];
        };
        if (low[axis] > 0.0 && std::all_of(t.begin(), t.end(), is_on_wall)) return true;
      }
      return false;
    });
    walls = joined(walls, room);
  }
  Shell result("rooms", boxes);
  result.mesh = walls;
  return result;
}

std::vector<Shell> closed_shells() {
  const TriangleMesh cube = cube_mesh(), other = box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
  const TriangleMesh ring = torus(1.0, 0.3, 24, 12);
  const TriangleMesh hollow = inverted(box_mesh({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}));
  const TriangleMesh core = box_mesh({0.3, 0.3, 0.3}, {0.6, 0.6, 0.6});
  // These overlap the cube and have a vertex in common with it, or an edge.
  const TriangleMesh at_vertex = {{{0, 0, 0}, {2, 0.3, 0.1}, {0.1, 2, 0.3}, {0.3, 0.1, 2}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const TriangleMesh at_edge = {{{0, 0, 0}, {1, 0, 0}, {0.1, 2, 1.2}, {0.3, 1.2, 2}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  return effort(
      std::vector<Shell>{
          {"nested", {cube, hollow, core}},
          {"double-sided", {cube, inverted(cube)}, false},
          {"one inverted", {cube, inverted(other)}},
          {"at an edge", {inverted(cube), at_edge}, false},
          rooms(2, 2, 1),
          {"torus", {ring}},
          {"overlapping", {cube, other}},
          {"at a vertex", {cube, at_vertex}},
          {"bracket", {l_bracket()}},
          {"apart", {cube, box_mesh({2.0, 0.0, 0.0}, {2.5, 0.5, 0.5})}},
          {"twice", {cube, cube}, false},
          {"double-sided ring", {inverted(ring), ring}, false},
          {"overlapping twice", {other, cube, inverted(cube), inverted(other)}, false},
          rooms(2, 3, 2)},
      5);
}

TEST(MeshShells, WhatAPartEnclosesIsInsideHoweverItIsDrawn) {
  Random random(31);
  for (const Shell& shell : closed_shells()) {
    const TriangleMesh& mesh = shell.mesh;
    std::vector<TriangleMesh> drawings = {mesh, inverted(mesh), double_sided(mesh)};
    if (shell.has_any_turn) {
      drawings.push_back(randomly_turned(mesh, 1));
      drawings.push_back(joined(mesh, randomly_turned(mesh, 2)));
    }
    int ways = 0;
    for (const TriangleMesh& drawn : drawings) {
      SCOPED_TRACE(shell.name + ", drawn in way " + std::to_string(ways++));
      const MeshInside inside(drawn);
      const MeshTree tree(drawn);
      EXPECT_TRUE(inside.is_closed());
      const Eigen::AlignedBox3d box = bounding_box(mesh);
      int counts[2] = {};
      for (int i = 0; i < effort(100, 30); ++i) {
        const Vector3d p = box.center() + random.point(0.6).cwiseProduct(box.sizes());
        if (distance_to_surface(mesh, p) < 1e-9) continue;
        const bool is_inside = shell.encloses(p);
        EXPECT_EQ(inside.contains(tree, p, 1e-12), is_inside) << p.transpose();
        ++counts[is_inside];
      }
      EXPECT_GT(std::min(counts[0], counts[1]), 2);
    }
  }
}

// A triangle upright on an edge of the unit cube.
TriangleMesh flap_on_cube() {
  return {{{0, 0, 1}, {1, 0, 1}, {0.5, 0, 2}}, {{0, 1, 2}}};
}

bool contains(const TriangleMesh& mesh, const Vector3d& point) {
  return MeshInside(mesh).contains(MeshTree(mesh), point, 1e-12);
}

const Vector3d kMiddle(0.45, 0.52, 0.57);
const Vector3d kOutside(1.2, 0.5, 0.4);

// Sheets, which the shell keeps what it encloses beside, or that enclose nothing.
TEST(MeshShells, SheetsAddAndTakeNothing) {
  const TriangleMesh cube = cube_mesh(), flap = double_sided(flap_on_cube());
  // A collinear facet, on one edge, is a sheet.
  for (const TriangleMesh& mesh :
       {joined(cube, flap), joined(double_sided(cube), flap), joined(rooms(2, 1, 1).mesh, flap),
        with_degenerates(double_sided(cube))}) {
    EXPECT_FALSE(MeshInside(mesh).is_closed());
    EXPECT_TRUE(MeshInside(mesh).has_inside());
    EXPECT_TRUE(contains(mesh, kMiddle));
    EXPECT_FALSE(contains(mesh, Vector3d(-0.2, 0.5, 0.4)));
  }
  for (const TriangleMesh& mesh : {flap, double_sided(open_box()), double_sided(without_last(cube)),
                                   double_sided(projective_plane()), randomly_turned(open_box(), 1),
                                   randomly_turned(projective_plane(), 1)}) {
    EXPECT_FALSE(MeshInside(mesh).is_closed());
    EXPECT_FALSE(MeshInside(mesh).has_inside());
    EXPECT_FALSE(contains(mesh, kMiddle));
  }
  // One side of one triangle missing is no hole.
  EXPECT_TRUE(contains(without_last(double_sided(cube)), kMiddle));
}

// Without its end wall, the last room is open to the outside, and only that one.
TEST(MeshShells, AnOpenRoomIsOutside) {
  for (const int x : {1, 2, 3}) {
    TriangleMesh open = rooms(x, 1, 1).mesh;
    std::erase_if(open.triangles, [&](const Eigen::Vector3i& t) {
      return std::all_of(t.begin(), t.end(), [&](int v) {
        return open.vertices[static_cast<std::size_t>(v)].x() == x;
      });
    });
    EXPECT_EQ(contains(open, kMiddle), x > 1);
    EXPECT_FALSE(contains(open, kMiddle + Vector3d(x - 1, 0, 0)));
    EXPECT_FALSE(MeshInside(open).is_closed());
  }
}

// More surfaces on the ray than are counted at a time, of which one encloses the point.
TEST(MeshShells, ManySurfacesOnOneRay) {
  const Vector3d direction = kRayDirections[0];
  TriangleMesh small;
  for (int i = 1; i <= 150; ++i) {
    const Vector3d middle = kMiddle + 0.02 * i * direction;
    small = joined(small,
                   box_mesh(middle - Vector3d::Constant(2e-3), middle + Vector3d::Constant(3e-3)));
  }
  const TriangleMesh cube = cube_mesh();
  EXPECT_FALSE(contains(small, kMiddle));
  EXPECT_TRUE(contains(joined(small, cube), kMiddle));
  EXPECT_TRUE(contains(joined(cube, small), kMiddle));
  EXPECT_TRUE(contains(joined(small, inverted(joined(cube, small))), kMiddle));
  EXPECT_FALSE(contains(joined(small, cube), kOutside));
  EXPECT_FALSE(contains(joined(small, cube), kMiddle - 2.0 * direction));
}

// Sets of small spheres all over the place, of which none, one or many are inside.
TEST(SolidMeshTest, AgreesWithWindingNumbers) {
  Random random(5);
  for (const Shell& shell : closed_shells()) {
    SCOPED_TRACE(shell.name);
    const TriangleMesh& mesh = shell.mesh;
    const SolidMesh solid(mesh);
    ASSERT_TRUE(solid.has_inside());
    ASSERT_TRUE(solid.is_closed());
    const Eigen::AlignedBox3d box = bounding_box(mesh);
    const double size = box.diagonal().norm();
    int counts[2] = {}, only_inside = 0;
    for (int i = 0; i < effort(150, 20); ++i) {
      const Pose world_from_mesh = random.pose(3.0);
      const Pose world_from_tree = random.pose(3.0);
      const Pose tree_from_mesh = world_from_tree.inverse() * world_from_mesh;
      std::vector<Sphere> spheres;
      bool touches = false, is_inside = false;
      double least = std::numeric_limits<double>::infinity();
      // Mostly outside, so that many sets are free in spite of their number.
      const bool may_enter = random.whole(0, 2) == 0;
      for (int k = random.whole(1, 40); k > 0; --k) {
        const Vector3d p = box.center() + random.point(0.7 * size);
        const double distance = distance_to_surface(mesh, p);
        const bool inside = shell.encloses(p);
        if (inside && !may_enter) continue;
        const double radius = distance * random.between(0.0, random.whole(0, 30) == 0 ? 1.5 : 0.98);
        touches = touches || radius > distance;
        is_inside = is_inside || inside;
        least = std::min(least, inside ? 0.0 : std::max(0.0, distance - radius));
        spheres.push_back({tree_from_mesh * p, radius});
      }
      if (spheres.empty()) continue;
      const SphereTree tree = build_tree(spheres);
      const bool hit = collides(tree, world_from_tree, solid, world_from_mesh);
      ASSERT_EQ(hit, touches || is_inside) << i;
      const DistanceResult result = distance(tree, world_from_tree, solid, world_from_mesh);
      ASSERT_LE(result.lower, least + 1e-12) << i;
      ASSERT_GE(result.upper, least - 1e-12) << i;
      ASSERT_LE(result.upper - result.lower, 1e-6) << i;
      ASSERT_EQ(deepest_contact(tree, world_from_tree, solid, world_from_mesh).has_value(), hit);
      ++counts[hit];
      only_inside += is_inside && !touches;
    }
    EXPECT_GT(counts[0], effort(20, 2));
    EXPECT_GT(counts[1], effort(20, 2));
    EXPECT_GT(only_inside, effort(3, 0));
  }
}

// Spheres in a row that overlap each other, as a cover's do, are free where nothing encloses them.
TEST(SolidMeshTest, ABoreIsFree) {
  const SolidMesh solid(pipe(0.5, 0.4, 1.0, 24));
  std::vector<Sphere> spheres;
  for (int i = 0; i <= 40; ++i) spheres.push_back({{0.0, 0.0, 0.3 + 0.01 * i}, 0.05});
  EXPECT_FALSE(collides(build_tree(spheres), Pose(), solid, Pose()));
  for (int i = 0; i <= 40; ++i) spheres.push_back({{0.7, 0.0, 0.3 + 0.01 * i}, 0.05});
  EXPECT_FALSE(collides(build_tree(spheres), Pose(), solid, Pose()));
  spheres.push_back({{0.45, 0.0, 0.5}, 0.01});  // in the wall
  EXPECT_TRUE(collides(build_tree(spheres), Pose(), solid, Pose()));
}

TEST(SolidMeshTest, AnOpenShellIsASurface) {
  const SolidMesh half(joined(open_box(), box_mesh({2.0, 0.0, 0.0}, {3.0, 1.0, 1.0})));
  EXPECT_FALSE(half.is_closed());
  EXPECT_TRUE(half.has_inside());
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, 0.5}, 0.1}), Pose(), half, Pose()));
  EXPECT_TRUE(collides(tree_of({{0.5, 0.5, 0.1}, 0.2}), Pose(), half, Pose()));
  EXPECT_TRUE(collides(tree_of({{2.5, 0.5, 0.5}, 0.1}), Pose(), half, Pose()));
}

// Spheres so near to a solid mesh that rounding does not tell on which side of it they are.

// Near faces, edges and corners of a box: there rays pass too near to an edge to tell. All numbers
// are multiples of 2^-44 below 2^9, so that sums are exact and the gap is known.
TEST(SolidDistance, BoundsHoldWhereTheInsideIsUncertain) {
  constexpr double kUnit = 0x1p-44;
  const SolidMesh solid(box_mesh({0, 0, 0}, {8, 8, 8}));
  Random random(11);
  int apart = 0;
  int inside = 0;
  int uncertain = 0;
  for (int i = 0; i < effort(20000, 2000); ++i) {
    Vector3d point(random.whole(1, 7), random.whole(1, 7), random.whole(1, 7));
    const double most = std::ldexp(kUnit, random.whole(0, 14));
    long double squared = 0.0L;
    for (int axis = random.whole(0, 2); axis < 3; ++axis) {
      const double step = std::trunc(random.between(-1.0, 1.0) * most / kUnit) * kUnit;
      point[axis] = 8.0 + step;
      if (step > 0.0) squared += static_cast<long double>(step) * step;
    }
    const Vector3d shift(random.whole(-200, 200), random.whole(-200, 200), random.whole(-200, 200));
    const Sphere sphere{point - shift, random.whole(0, 1) == 0 ? 0.0 : random.whole(0, 99) * kUnit};
    const long double exact = std::max(0.0L, std::sqrt(squared) - sphere.radius);
    const DistanceResult found =
        distance(build_tree(std::span(&sphere, 1)), Pose::from_translation(shift), solid, Pose());
    ASSERT_LE(found.lower, exact * (1.0L + 0x1p-60L)) << i;
    ASSERT_GE(found.upper, exact * (1.0L - 0x1p-60L)) << i;
    apart += exact > 0.0L ? 1 : 0;
    inside += found.upper == 0.0 ? 1 : 0;
    uncertain += found.lower == 0.0 && found.upper > 0.0 ? 1 : 0;
  }
  EXPECT_GT(apart, effort(2000, 200));
  EXPECT_GT(inside, effort(200, 20));
  EXPECT_GT(uncertain, effort(200, 20));
}

// Two meshes of needles within a clearance, against 100 digits, and the boxes that cut it short.

// Long thin triangles, half of them along an axis of their frame, as strips of a tube are.
TriangleMesh needles(Random& random, int count, double size) {
  TriangleMesh mesh = random_triangles(random, count, size, 1e-2 * size);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 6) {
    const Vector3d along = size * Vector3d::Unit(random.whole(0, 2));
    mesh.vertices[i + 1] = mesh.vertices[i] + along;
    mesh.vertices[i + 2] = mesh.vertices[i] + random.point(1e-2 * size);
  }
  return mesh;
}

TEST(SolidWithin, MeshesOfNeedlesAreJudgedByTheirExactGap) {
  Random random(23);
  int apart = 0;
  for (int n = 0; n < effort(80, 8); ++n) {
    const double size = std::ldexp(1.0, random.whole(-20, 17));
    const TriangleMesh mesh_a = needles(random, 14, size), mesh_b = needles(random, 14, size);
    const SolidMesh a(mesh_a), b(mesh_b);
    const Pose world_from_a = random.pose(2.0 * size);
    const Pose world_from_b = random.pose(2.0 * size);
    const double gap = exact_gap(mesh_a, world_from_a, mesh_b, world_from_b);
    const double above = std::nextafter(gap, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(within(a, world_from_a, b, world_from_b, gap == 0.0 ? 0.0 : above)) << n;
    EXPECT_EQ(within(a, world_from_a, b, world_from_b, 0.0),
              within(b, world_from_b, a, world_from_a, 0.0));
    const double below = gap - 1e-12 * size;
    if (below <= 0.0) continue;
    ++apart;
    EXPECT_FALSE(within(a, world_from_a, b, world_from_b, below)) << n;
  }
  EXPECT_GT(apart, effort(40, 3));
}

// A node's box holds the triangles of all leaves below it, and is no larger than they need.
void expect_box_of_triangles(const MeshTree& mesh, const internal::NodeBoxes& boxes,
                             std::size_t node) {
  std::vector<std::size_t> todo{node};
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  while (!todo.empty()) {
    const std::size_t at = todo.back();
    todo.pop_back();
    if (mesh.tree().is_leaf(at)) {
      for (const Vector3d& corner : mesh.triangle(mesh.tree().sphere_index(at))) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    for (std::int32_t i = 0; i < mesh.tree().child_count(at); ++i) {
      todo.push_back(static_cast<std::size_t>(mesh.tree().first_child(at) + i));
    }
  }
  const AxisAlignedBox box = boxes.box(node);
  for (int i = 0; i < 3; ++i) {
    const Real center = box.center[i], half = box.half_size[i];
    EXPECT_TRUE(center - half <= Real(low[i]) && Real(high[i]) <= center + half);
    EXPECT_LE(std::abs(box.center[i]) + box.half_size[i],
              mesh.tree().reach() * (1.0 + 0x1p-21) + 0x1p-125);
    const double farthest = std::max(std::abs(low[i]), std::abs(high[i]));
    EXPECT_LE(box.half_size[i], 0.5 * high[i] - 0.5 * low[i] + 0x1p-21 * farthest + 0x1p-125);
  }
}

TEST(NodeBoxes, HoldTheTrianglesBelowTheirNodes) {
  Random random(24);
  for (int n = 0; n < effort(60, 20); ++n) {
    const double size = std::ldexp(1.0, random.whole(n % 3 == 0 ? -500 : -20, 30));
    const MeshTree mesh(needles(random, random.whole(1, 100), size));
    const internal::NodeBoxes boxes(mesh);
    for (std::size_t node = 0; node < mesh.tree().node_count(); ++node) {
      expect_box_of_triangles(mesh, boxes, node);
    }
  }
}

}  // namespace
}  // namespace spherule::test
