// SPDX-License-Identifier: BSD-3-Clause
// Rays and insides, against rational numbers and against what is built in.

#include "collide/meshes/mesh_inside.h"

#include "geometry/ray.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/scene_random.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

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
  SceneRandom random(1);
  int through = 0, by = 0, uncertain = 0;
  for (int i = 0; i < 6000; ++i) {
    Triangle t = {random.point(1.0), random.point(1.0), random.point(1.0)};
    if (random.whole(0, 9) == 0) t[2] = t[0] + random.uniform(0.0, 1.0) * (t[1] - t[0]);
    const Vector3d direction = random.whole(0, 1) == 0
                                   ? kRayDirections[static_cast<std::size_t>(random.whole(0, 7))]
                                   : Vector3d::Unit(random.whole(0, 2));
    const double v = random.whole(0, 1) * random.uniform(0.0, 1.0);
    const double w = random.whole(0, 1) * random.uniform(0.0, 1.0 - v);
    constexpr double kErrors[] = {0.0, 1e-15, 1e-12, 1e-6};
    const double error = kErrors[random.whole(0, 3)];
    const double near = kErrors[random.whole(0, 3)];
    const Vector3d target = t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]) + near * random.point(1.0);
    const Vector3d point = target - random.whole(-1, 3) * random.uniform(0.0, 1.0) * direction;
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
  SceneRandom random(2);
  int met = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d direction = Vector3d::Unit(random.whole(0, 2));
    const Vector3d point = random.point(1.0);
    // A sphere that the ray touches, up to rounding, from within or without, or starts behind.
    const double along = random.uniform(-0.5, 1.0);
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

}  // namespace
}  // namespace spherule::test
