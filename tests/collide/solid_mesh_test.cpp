// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/solid_mesh.h"

#include "base/error.h"
#include "collide/meshes/mesh_inside.h"
#include "collide/search/relative_pose.h"
#include "collide/solids/solid_within.h"
#include "spheretree/build.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace spherule::test {
namespace {

// Spheres and meshes with their inside: tetrahedra next to contact in 100 digits, and shells of all
// kinds against winding numbers from solid angles.

using Eigen::Vector3d;

// --- shells of all kinds ---

// By the solid angles of the triangles (Van Oosterom and Strackee, "The Solid Angle of a Plane
// Triangle", 1983); for points off the surface.
double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto at = [&](int k) -> Vector3d {
      return mesh.vertices[static_cast<std::size_t>(t[k])] - p;
    };
    const Vector3d a = at(0), b = at(1), c = at(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

double distance_to_surface(const TriangleMesh& mesh, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    ExactTriangle<double> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = exact<double>(mesh.vertices[static_cast<std::size_t>(t[static_cast<int>(k)])]);
    }
    least = std::min(least, squared_distance_to_triangle(exact<double>(p), triangle));
  }
  return std::sqrt(least);
}

// A mesh of parts that are closed each; what one of them encloses is inside.
struct Shell {
  std::string name;
  std::vector<TriangleMesh> parts;

  TriangleMesh mesh() const {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) all = joined(all, part);
    return all;
  }
  bool encloses(const Vector3d& p) const {
    return std::any_of(parts.begin(), parts.end(), [&](const TriangleMesh& part) {
      return std::abs(winding_number(part, p)) > 0.5;
    });
  }
};

std::vector<Shell> closed_shells() {
  const TriangleMesh cube = cube_mesh(), shifted = box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
  const TriangleMesh ring = torus(1.0, 0.3, 24, 12);
  const TriangleMesh core = box_mesh({0.3, 0.3, 0.3}, {0.6, 0.6, 0.6});
  return effort(std::vector<Shell>{{"nested", {cube, inverted(core)}},
                                   {"double-sided", {cube, inverted(cube)}},
                                   {"one inverted", {cube, inverted(shifted)}},
                                   {"torus", {ring}},
                                   {"overlapping", {cube, shifted}},
                                   {"inverted", {inverted(icosphere(2))}},
                                   {"bracket", {l_bracket()}},
                                   {"apart", {cube, box_mesh({2.0, 0.0, 0.0}, {2.5, 0.5, 0.5})}},
                                   {"twice", {cube, cube}},
                                   {"double-sided ring", {inverted(ring), ring}},
                                   {"double-sided, overlapping",
                                    {shifted, cube, inverted(cube), inverted(shifted)}}},
                4);
}

// Sets of small spheres all over the place, of which none, one or many are inside.
TEST(SolidMeshTest, AgreesWithWindingNumbers) {
  Random random(5);
  for (const Shell& shell : closed_shells()) {
    SCOPED_TRACE(shell.name);
    const TriangleMesh mesh = shell.mesh();
    const SolidMesh solid(mesh);
    ASSERT_TRUE(solid.has_inside());
    ASSERT_TRUE(solid.is_closed());
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
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

TEST(SolidMeshTest, OpenAndUnorientableShellsHaveNoInside) {
  const SolidMesh open(open_box());
  EXPECT_FALSE(open.is_closed());
  EXPECT_FALSE(open.has_inside());
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, 0.5}, 0.1}), Pose(), open, Pose()));
  EXPECT_TRUE(collides(tree_of({{0.5, 0.5, 0.1}, 0.2}), Pose(), open, Pose()));
  EXPECT_FALSE(SolidMesh(klein_bottle(16, 24)).has_inside());

  const SolidMesh half(joined(open_box(), box_mesh({2.0, 0.0, 0.0}, {3.0, 1.0, 1.0})));
  EXPECT_FALSE(half.is_closed());
  EXPECT_TRUE(half.has_inside());
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, 0.5}, 0.1}), Pose(), half, Pose()));
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
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3d start = random.point(size);
    Vector3d along = random.point(size);
    if (i % 2 == 0) along = size * Vector3d::Unit(random.whole(0, 2));
    const Vector3d wide = random.point(1e-2 * size);
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& corner : {start, Vector3d(start + along), Vector3d(start + wide)}) {
      mesh.vertices.push_back(corner);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

double exact_gap_of(const MeshTree& a, const Pose& world_from_a, const MeshTree& b,
                    const Pose& world_from_b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.tree().spheres().size(); ++i) {
    for (std::size_t j = 0; j < b.tree().spheres().size(); ++j) {
      least = std::min(least, exact_gap(a.triangle(static_cast<std::int32_t>(i)), world_from_a,
                                        b.triangle(static_cast<std::int32_t>(j)), world_from_b));
    }
  }
  return least;
}

TEST(SolidWithin, MeshesOfNeedlesAreJudgedByTheirExactGap) {
  Random random(23);
  int apart = 0;
  for (int n = 0; n < effort(80, 8); ++n) {
    const double size = std::ldexp(1.0, random.whole(-20, 17));
    const SolidMesh a(needles(random, 14, size));
    const SolidMesh b(needles(random, 14, size));
    const Pose world_from_a = random.pose(2.0 * size);
    const Pose world_from_b = random.pose(2.0 * size);
    const double gap = exact_gap_of(a.mesh(), world_from_a, b.mesh(), world_from_b);
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
