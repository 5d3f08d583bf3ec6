// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_inside.h"

#include "geometry/ray.h"
#include "geometry/shells.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// Rays and insides, against rational numbers and against what is built in.

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
    const double angle = 6.283185307179586 * i / sides;
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
      ASSERT_EQ(inside.component_points().size(), 1u);
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
    EXPECT_EQ(inside.component_points().size(), 2u);
    EXPECT_TRUE(inside.contains(MeshTree(mesh), Vector3d::Zero(), 0.0));
    EXPECT_FALSE(inside.contains(MeshTree(mesh), -1.2 * kRayDirections[0], 0.0));
    // So that one of both ways round the flap would take away what the pyramid adds.
    mesh.triangles.pop_back();
    std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
  }
}

// Insides of meshes whose triangles do not simply face outwards.

TriangleMesh double_sided(const TriangleMesh& mesh) {
  return joined(mesh, inverted(mesh));
}

TriangleMesh without_last(TriangleMesh mesh) {
  mesh.triangles.pop_back();
  return mesh;
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

void expect_solid(const TriangleMesh& mesh, bool is_closed = true) {
  const MeshInside inside(mesh);
  EXPECT_EQ(inside.is_closed(), is_closed);
  EXPECT_TRUE(inside.has_inside());
  EXPECT_TRUE(contains(mesh, kMiddle));
  EXPECT_FALSE(contains(mesh, kOutside));
}

void expect_nothing_inside(const TriangleMesh& mesh) {
  const MeshInside inside(mesh);
  EXPECT_FALSE(inside.is_closed());
  EXPECT_FALSE(inside.has_inside());
  EXPECT_FALSE(contains(mesh, kMiddle));
}

TEST(MeshShells, ADoubleSidedShellHasItsInside) {
  expect_solid(double_sided(cube_mesh()));
  expect_solid(double_sided(double_sided(cube_mesh())));
  expect_solid(joined(double_sided(cube_mesh()), cube_mesh()));
  // A collinear facet, on one edge, is a sheet.
  expect_solid(with_degenerates(double_sided(cube_mesh())), false);
  // The first of two alike facing inwards for some and outwards for the others.
  TriangleMesh mixed = double_sided(cube_mesh());
  std::rotate(mixed.triangles.begin(), mixed.triangles.begin() + 5, mixed.triangles.end());
  expect_solid(mixed);
  // One side of one triangle missing.
  expect_solid(without_last(double_sided(cube_mesh())));
}

TEST(MeshShells, ADoubleSidedSheetHasNone) {
  expect_nothing_inside(double_sided(flap_on_cube()));
  expect_nothing_inside(double_sided(open_box()));
  expect_nothing_inside(double_sided(without_last(cube_mesh())));
  expect_nothing_inside(double_sided(klein_bottle(16, 24)));
}

// The shell on whose edge it stands keeps what it encloses, however it is drawn.
TEST(MeshShells, ADoubleSidedFlapTakesNothingAway) {
  const TriangleMesh flap = double_sided(flap_on_cube());
  expect_solid(joined(cube_mesh(), flap), false);
  expect_solid(joined(double_sided(cube_mesh()), flap), false);
}

TEST(MeshShells, PartsDoNotCancelEachOther) {
  const TriangleMesh a = box_mesh({-1, -1, -1}, {1, 1, 1});
  const TriangleMesh b = inverted(box_mesh({-.7, -.8, -.9}, {1.2, 1.3, 1.4}));
  EXPECT_TRUE(MeshInside(joined(a, b)).is_closed());
  EXPECT_TRUE(contains(joined(a, b), Vector3d::Zero()));
  EXPECT_TRUE(contains(joined(double_sided(a), b), Vector3d::Zero()));
  EXPECT_TRUE(contains(joined(double_sided(a), double_sided(b)), Vector3d::Zero()));
}

// Two that overlap and have a vertex in common, or an edge.
TEST(MeshShells, NorDoPartsThatShareAVertexOrAnEdge) {
  const TriangleMesh cube = cube_mesh();
  const TriangleMesh at_vertex = {{{0, 0, 0}, {2, 0.3, 0.1}, {0.1, 2, 0.3}, {0.3, 0.1, 2}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const TriangleMesh at_edge = {{{0, 0, 0}, {1, 0, 0}, {0.1, 2, 1.2}, {0.3, 1.2, 2}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Vector3d in_both(0.4, 0.4, 0.4);
  for (const TriangleMesh& other : {at_vertex, inverted(at_vertex)}) {
    ASSERT_TRUE(contains(other, in_both));
    EXPECT_TRUE(contains(joined(cube, other), in_both));
    EXPECT_TRUE(contains(joined(double_sided(cube), double_sided(other)), in_both));
  }
  for (const TriangleMesh& other : {at_edge, inverted(at_edge)}) {
    ASSERT_TRUE(contains(other, in_both));
    EXPECT_TRUE(contains(joined(cube, other), in_both));
    EXPECT_TRUE(contains(joined(other, inverted(cube)), in_both));
    EXPECT_TRUE(contains(joined(double_sided(cube), double_sided(other)), in_both));
    EXPECT_TRUE(contains(joined(double_sided(other), double_sided(cube)), in_both));
  }
}

TEST(MeshShells, HollowsAndWhatIsInThemAreInside) {
  for (const int count : {2, 3}) {
    const TriangleMesh shells = nested_shells(count);
    for (const TriangleMesh& mesh : {shells, inverted(shells), double_sided(shells)}) {
      expect_solid(mesh);
      EXPECT_TRUE(contains(mesh, {0.05, 0.5, 0.45}));
      EXPECT_TRUE(contains(mesh, {0.22, 0.5, 0.45}));
    }
  }
}

TriangleMesh randomly_turned(TriangleMesh mesh, unsigned seed) {
  Random random(seed);
  for (Eigen::Vector3i& t : mesh.triangles) {
    if (random.whole(0, 1) == 0) std::swap(t[0], t[1]);
  }
  return mesh;
}

TEST(MeshShells, TrianglesThatAreTurnedAnyWayHaveTheirInside) {
  for (unsigned seed = 1; seed <= static_cast<unsigned>(effort(5, 1)); ++seed) {
    expect_solid(randomly_turned(cube_mesh(), seed));
    expect_nothing_inside(randomly_turned(open_box(), seed));
    expect_nothing_inside(randomly_turned(klein_bottle(16, 24), seed));
  }
}

// A box of unit cubes, four walls to an edge; each wall is drawn once, by the first of the two.
TriangleMesh rooms(int x, int y, int z) {
  TriangleMesh mesh;
  for (int i = 0; i < x * y * z; ++i) {
    const Vector3d low(i % x, i / x % y, i / x / y);
    TriangleMesh room = box_mesh(low, low + Vector3d::Ones());
    std::erase_if(room.triangles, [&](const Eigen::Vector3i& t) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto is_on_wall = [&](int v) {
          return room.vertices[static_cast<std::size_t>(v)][axis] == low[axis];
        };
        if (low[axis] > 0.0 && std::all_of(t.begin(), t.end(), is_on_wall)) return true;
      }
      return false;
    });
    mesh = joined(mesh, room);
  }
  return mesh;
}

TEST(MeshShells, RoomsWithWallsBetweenThemAreInside) {
  const std::vector<std::array<int, 3>> sizes = {{2, 1, 1}, {2, 2, 1}, {3, 1, 1}, {2, 3, 2}};
  for (const auto& [x, y, z] : effort(sizes, 2)) {
    const TriangleMesh mesh = rooms(x, y, z);
    const TriangleMesh with_flap = joined(mesh, double_sided(flap_on_cube()));
    EXPECT_FALSE(MeshInside(with_flap).is_closed());
    for (const TriangleMesh& drawn :
         {mesh, inverted(mesh), double_sided(mesh), randomly_turned(mesh, 1),
          joined(mesh, randomly_turned(mesh, 2)), with_flap}) {
      EXPECT_TRUE(MeshInside(drawn).is_closed() || drawn.vertices == with_flap.vertices);
      for (int i = 0; i < x * y * z; ++i) {
        const Vector3d middle = kMiddle + Vector3d(i % x, i / x % y, i / x / y);
        EXPECT_TRUE(contains(drawn, middle)) << middle.transpose();
      }
      for (const Vector3d& outside :
           {Vector3d(-0.2, 0.5, 0.4), Vector3d(x + 0.2, 0.5, 0.4), Vector3d(0.5, 0.4, z + 0.2)}) {
        EXPECT_FALSE(contains(drawn, outside)) << outside.transpose();
      }
    }
    // Without its end wall, the last room is open to the outside, and only that one.
    TriangleMesh open = mesh;
    std::erase_if(open.triangles, [&, end = x](const Eigen::Vector3i& t) {
      return std::all_of(t.begin(), t.end(), [&](int v) {
        return open.vertices[static_cast<std::size_t>(v)].x() == end;
      });
    });
    EXPECT_EQ(contains(open, kMiddle), x > 1);
    EXPECT_FALSE(contains(open, kMiddle + Vector3d(x - 1, 0, 0)));
    EXPECT_EQ(MeshInside(open).is_closed(), false);
  }
}

// More surfaces on the ray than are counted at a time, of which one encloses the point.
TEST(MeshShells, ManySurfacesOnOneRay) {
  const Vector3d direction = internal::kRayDirections[0];
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

}  // namespace
}  // namespace spherule::test
