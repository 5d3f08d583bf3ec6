// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_search.h"

#include "base/error.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/relative_pose.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace spherule::test {
namespace {

// Spheres against triangles on every instruction set, judged in 100 digits and by the test in
// double for all pairs.

using Triangle = std::array<Eigen::Vector3d, 3>;

Real exact_distance(const Eigen::Vector3d& p, const Pose& world_from_a, const Triangle& corners,
                    const Pose& world_from_b) {
  return sqrt(squared_distance_to_triangle(transform(world_from_a, exact<Real>(p)),
                                           placed<Real>(world_from_b, corners)));
}

// A point of the triangle: a corner, a point of an edge, or one inside.
Eigen::Vector3d point_of(Random& random, const Triangle& t) {
  const double u = random.between(0.0, 1.0);
  switch (random.whole(0, 2)) {
    case 0:
      return t[0];
    case 1:
      return t[1] + u * (t[2] - t[1]);
    default:
      return t[0] + random.between(0.0, 1.0 - u) * (t[1] - t[0]) + u * (t[2] - t[0]);
  }
}

// Ordinary triangles, needles, segments and points.
Triangle random_triangle(Random& random, double size) {
  static constexpr double kThin[] = {1.0, 1.0, 1e-3, 1e-6, 1e-7, 1e-8, 1e-12, 0.0};
  const double thin = kThin[random.whole(0, 7)];
  const Eigen::Vector3d a = random.point(size);
  const Eigen::Vector3d edge =
      random.whole(0, 9) == 0 ? Eigen::Vector3d::Zero() : random.point(size).eval();
  return {a, a + edge, a + random.between(0.0, 1.0) * edge + random.point(size * thin)};
}

// Relative gaps at which contact is tested.
double random_gap(Random& random) {
  static constexpr double kGaps[] = {0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3, 0.1};
  return (random.whole(0, 1) == 0 ? -1.0 : 1.0) * kGaps[random.whole(0, 9)];
}

TriangleMesh mesh_of(const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  for (const Triangle& t : triangles) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

TEST(MeshSearch, MissesNoContactWithOneTriangleOnAnyInstructionSet) {
  Random random(11);
  int touching = 0;
  int near = 0;
  int free = 0;
  for (int i = 0; i < 6000; ++i) {
    const double size = std::pow(10.0, random.whole(-6, 6));
    const Triangle triangle = random_triangle(random, size);
    const MeshTree mesh(mesh_of({triangle}));
    const Pose world_from_a = random.pose(size);
    const Pose world_from_b = random.pose(size * std::pow(10.0, random.whole(-3, 1)));
    // From a point of the triangle outwards, seen from the sphere's frame.
    const Eigen::Vector3d direction = random.point(1.0).normalized();
    const double length = size * std::pow(10.0, random.whole(-9, 1));
    const Eigen::Vector3d center =
        world_from_a.inverse() * (world_from_b * (point_of(random, triangle) + length * direction));
    Sphere sphere{center, 0.0};
    const Real distance = exact_distance(center, world_from_a, triangle, world_from_b);
    if (random.whole(0, 9) != 0) {
      sphere.radius = std::max(0.0, distance.convert_to<double>() * (1.0 + random_gap(random)));
    }
    const SphereTree tree = tree_of(sphere);
    const Real gap = distance - sphere.radius;
    const bool expected = intersects_triangle(tree, 0, world_from_a, mesh, 0, world_from_b);
    ASSERT_TRUE(expected || gap > 0) << "missed by " << gap;
    // Distances to needles are loose in double.
    const double slack =
        2.5 * collision_slack(tree, world_from_a, mesh.tree(), world_from_b) + 1e-9 * size;
    ASSERT_TRUE(!expected || gap <= slack) << "invented, apart by " << gap;
    // The same with a part of the radius as a clearance.
    Sphere smaller = sphere;
    smaller.radius *= random.between(0.0, 1.0);
    const double clearance = sphere.radius - smaller.radius;
    const SphereTree smaller_tree = tree_of(smaller);
    const internal::RelativePose pose(smaller_tree, world_from_a, mesh.tree(), world_from_b);
    const bool expected_within =
        internal::TriangleLeaves(smaller_tree, mesh, pose, clearance).touches(std::int32_t{0}, 0);
    ASSERT_TRUE(expected_within || distance > Real(smaller.radius) + clearance) << i;
    for (const InstructionSet set : instruction_sets()) {
      ASSERT_EQ(internal::collides_by(internal::mesh_kernel_for(set), smaller_tree, world_from_a,
                                      mesh, world_from_b, clearance),
                expected_within)
          << i;
      ASSERT_EQ(internal::collides_by(internal::mesh_kernel_for(set), tree, world_from_a, mesh,
                                      world_from_b),
                expected)
          << "case " << i << ", gap " << gap;
    }
    touching += gap <= 0;
    free += !expected;
    near += gap > 0 && gap < 1e-6 * size;
  }
  EXPECT_GT(touching, 1500);
  EXPECT_GT(free, 1000);
  EXPECT_GT(near, 500);
}

// The promise that filters in single precision rely on.
TEST(MeshSearch, TheAxesFindApartWhatIsClearlyApart) {
  Random random(12);
  int judged = 0;
  int needed = 0;
  for (int i = 0; i < effort(20000, 5000); ++i) {
    const Triangle t = random_triangle(random, 1.0);
    const Eigen::Vector3d p =
        point_of(random, t) + std::pow(10.0, random.whole(-7, 1)) * random.point(1.0);
    double size = 0.0;
    for (const Eigen::Vector3d& corner : t) size = std::max(size, p.norm() + corner.norm());
    const Real distance = exact_distance(p, Pose(), t, Pose());
    const double d = distance.convert_to<double>();
    ASSERT_FALSE(internal::are_apart(p, t, d * (1.0 + 1e-15) + 8.0 * 0x1p-53 * size)) << i;
    const std::array<Eigen::Vector3d, 3> edges = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const double longest = std::max({edges[0].norm(), edges[1].norm(), edges[2].norm()});
    const double height = edges[0].cross(edges[1]).norm() / longest;
    const double reach = d - 0x1p-23 * size * (1.0 + 1e-9);
    if (!(d >= 0x1p-22 * size && reach >= 0.0 && height >= 0x1.01p-24 * longest)) continue;
    ASSERT_TRUE(internal::are_apart(p, t, reach)) << i;
    ++judged;
    needed += height < 1e-5 * longest;
  }
  EXPECT_GT(judged, effort(8000, 2000));
  EXPECT_GT(needed, effort(500, 125));
}

// Spheres anywhere, and one beyond the first corner of every triangle, seen from the middle of the
// leaf's sphere, so that the gaps to the triangle and to that are the same: 1e-16 to 1e-9 of the
// size, of both signs. There the pads decide, and least of all may the trees (G7).
std::vector<Sphere> spheres_among(Random& random, const MeshTree& mesh, const Pose& a_from_b,
                                  double size) {
  std::vector<Sphere> spheres = random_spheres(random, random.whole(1, 60), 1.0, 0.15);
  const bool are_points = random.chance(0.1);
  for (Sphere& s : spheres) s = {size * s.center, are_points ? 0.0 : size * s.radius};
  const int triangles = random.coin() ? static_cast<int>(mesh.tree().spheres().size()) : 1;
  for (int i = 0; i < triangles; ++i) {
    const Sphere leaf = mesh.tree().spheres()[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& corner = mesh.triangle(i)[0];
    const double gap = (random.chance(0.25) ? -1.0 : 1.0) * random.magnitude(1e-16, 1e-9);
    const double radius = random.between(0.01, 0.05);
    const Eigen::Vector3d outwards = (corner - leaf.center).stableNormalized();
    spheres.push_back({a_from_b * (corner + size * (radius + gap) * outwards), size * radius});
  }
  return spheres;
}

TEST(MeshSearch, AnswersAsAllPairsDo) {
  Random random(13);
  int hits = 0;
  std::size_t pairs = 0;
  for (int i = 0; i < effort(400, 100); ++i) {
    const double size = std::pow(10.0, random.whole(-3, 3));
    const double spread = random.chance(0.3) ? 10.0 * size : size;
    std::vector<Triangle> triangles;
    const int count = i % 20 == 0 ? random.whole(100, 700) : random.whole(1, 60);
    for (int k = 0; k < count; ++k) {
      Triangle t = random_triangle(random, 0.2 * size);
      const Eigen::Vector3d shift = random.point(spread);
      for (Eigen::Vector3d& corner : t) corner += shift;
      triangles.push_back(t);
    }
    const MeshTree b(mesh_of(triangles));
    const Pose world_from_a = random.pose(size);
    const Eigen::Quaterniond turned = random.quaternion();
    const Pose world_from_b(turned, world_from_a.translation() + random.point(1.8 * size));
    const std::vector<Sphere> spheres =
        spheres_among(random, b, world_from_a.inverse() * world_from_b, size);
    std::vector<SpherePair> expected;
    for (const int branching : {2, 8, 16}) {
      const SphereTree a = build_tree(spheres, {.branching = branching});
      const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
      for (std::int32_t j = 0; branching == 2 && j < static_cast<int>(spheres.size()); ++j) {
        for (std::int32_t k = 0; k < count; ++k) {
          if (!intersects_triangle(a, j, world_from_a, b, k, world_from_b)) continue;
          expected.push_back({j, k});
          // What is accepted must be a pair that the node tests are proved to keep.
          ASSERT_TRUE(pose.touches(spheres[static_cast<std::size_t>(j)],
                                   b.tree().spheres()[static_cast<std::size_t>(k)]));
        }
      }
      const CollisionResult result = collide(a, world_from_a, b, world_from_b);
      ASSERT_TRUE(result.complete);
      ASSERT_EQ(result.pairs, expected) << "case " << i << ", branching " << branching;
      ASSERT_EQ(collides(a, world_from_a, b, world_from_b), !expected.empty());
      for (const InstructionSet set : instruction_sets()) {
        ASSERT_EQ(
            internal::collides_by(internal::mesh_kernel_for(set), a, world_from_a, b, world_from_b),
            !expected.empty())
            << "case " << i;
      }
    }
    hits += expected.empty() ? 0 : 1;
    pairs += expected.size();
  }
  EXPECT_GT(hits, effort(100, 25));
  EXPECT_LT(hits, effort(400, 100));
  EXPECT_GT(pairs, effort(1000u, 250u));
}

// A triangle that is said to be so deep in a sphere has a point so far from its surface.
TEST(MeshSearch, TheDepthInASphereIsNoMoreThanItIs) {
  Random random(16);
  int deep = 0;
  int nearly = 0;
  for (int i = 0; i < 6000; ++i) {
    const double size = std::pow(10.0, random.whole(-6, 6));
    const Triangle triangle = random_triangle(random, size);
    const auto covered = covered_surface(mesh_of({triangle}));
    const Pose world_from_a = random.pose(size);
    const Pose world_from_b = random.pose(size);
    const Eigen::Vector3d center =
        world_from_b.inverse() * (world_from_a * (point_of(random, triangle) + random.point(size)));
    const auto other = one_sphere_tree(center, random.between(0.0, 2.0 * size));
    const auto [index, depth] =
        nearest_triangle(*covered, 0, world_from_a, *other, 0, world_from_b);
    ASSERT_EQ(index, 0);
    ASSERT_EQ(depth, contact_depth(*covered, 0, world_from_a, *other, 0, world_from_b));
    const Real exact_depth =
        other->spheres()[0].radius - exact_distance(center, world_from_b, triangle, world_from_a);
    ASSERT_LE(depth, exact_depth) << i;
    deep += depth > 0.0;
    nearly += depth > exact_depth - 1e-9 * size;
  }
  EXPECT_GT(deep, 1500);
  EXPECT_GT(nearly, 5000);
}

TEST(MeshTree, RefusesAMeshItCannotUse) {
  EXPECT_THROW(MeshTree(TriangleMesh{}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, -1}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, std::nan("")}}, {{0, 0, 0}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, 0}}, -1.0}), Error);
}

// What within() and distance() say of the surface alone.
TEST(MeshTreeTest, SurfaceWithinAClearance) {
  const MeshTree cube(cube_mesh());
  const SphereTree sphere = tree_of({{0.5, 0.5, 0.5}, 0.25});
  EXPECT_FALSE(within(sphere, Pose(), cube, Pose(), 0.2));
  EXPECT_TRUE(within(sphere, Pose(), cube, Pose(), 0.25));
  EXPECT_NEAR(distance(sphere, Pose(), cube, Pose()).lower, 0.25, 1e-12);
  EXPECT_NEAR(distance(sphere, Pose(), cube, Pose()).upper, 0.25, 1e-12);
}

}  // namespace
}  // namespace spherule::test
