// SPDX-License-Identifier: BSD-3-Clause
// Spheres against triangles, with the distance of point and triangle in 100 digits as the oracle.

#include "collide/meshes/mesh_tree.h"

#include "base/error.h"
#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spherule::test {
namespace {

Real exact_distance(const Sphere& sphere, const Pose& world_from_a,
                    const std::array<Eigen::Vector3d, 3>& corners, const Pose& world_from_b) {
  const Real square = squared_distance_to_triangle(
      transform(world_from_a, exact<Real>(sphere.center)), placed<Real>(world_from_b, corners));
  return sqrt(square);
}

// Random triangles, or needles where `thin` is small.
TriangleMesh random_mesh(SceneRandom& random, int count, double size, double thin) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const int first = 3 * i;
    const Eigen::Vector3d a = random.point(size);
    const Eigen::Vector3d edge = random.point(size);
    mesh.vertices.insert(mesh.vertices.end(),
                         {a, a + edge, a + random.uniform(0.0, 1.0) * edge + random.point(thin)});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

SphereTree tree_of(const Sphere& sphere) {
  return build_tree(std::span(&sphere, 1));
}

void compare_near_contact(double thin, double largest_excess, int least_extra) {
  SceneRandom random(1);
  int touching = 0;
  int extra = 0;
  for (int i = 0; i < 1500; ++i) {
    const MeshTree mesh(random_mesh(random, 1, 1.0, thin));
    const Pose world_from_a = random.pose(1.0);
    const Pose world_from_b = random.pose(1.0);
    Sphere sphere{random.point(1.0), 0.0};
    const Real exact = exact_distance(sphere, world_from_a, mesh.triangle(0), world_from_b);
    sphere.radius = exact.convert_to<double>() * (1.0 + random.whole(-2, 2) * 0x1p-52);
    const SphereTree tree = tree_of(sphere);
    const bool hit = collides(tree, world_from_a, mesh, world_from_b);
    const Real gap = exact - sphere.radius;
    ASSERT_TRUE(hit || gap > 0) << "missed by " << gap;
    const double slack =
        2.5 * collision_slack(tree, world_from_a, mesh.tree(), world_from_b) + largest_excess;
    ASSERT_TRUE(!hit || gap <= slack) << gap;
    touching += gap <= 0;
    extra += hit && gap > 0;

    // Clearly apart must be free.
    const SphereTree smaller =
        tree_of({sphere.center, std::max(0.0, sphere.radius - 2.0 * slack - 1e-12)});
    if (sphere.radius > 1e-3) {
      ASSERT_FALSE(collides(smaller, world_from_a, mesh, world_from_b));
    }
  }
  EXPECT_GT(touching, 300);
  EXPECT_GT(extra, least_extra);
}

TEST(MeshTree, ContactWithATriangleIsNeverMissed) {
  compare_near_contact(1.0, 0.0, 300);
}
TEST(MeshTree, ContactWithANeedleIsNeverMissed) {
  compare_near_contact(1e-9, 1e-10, 100);
}
TEST(MeshTree, ContactWithADegenerateTriangleIsNeverMissed) {
  compare_near_contact(0.0, 1e-10, 100);
}

TEST(MeshTree, FindsThePairsOfAllPairs) {
  SceneRandom random(2);
  int hits = 0;
  for (int i = 0; i < effort(20, 6); ++i) {
    const SphereTree a = build_tree(random_spheres(random, 30, 1.0, 0.2));
    const MeshTree b(random_mesh(random, 20, 0.5, 0.5));
    const Pose world_from_a = random.pose(0.5);
    const Pose world_from_b = random.pose(0.5);
    const CollisionResult result = collide(a, world_from_a, b, world_from_b);
    ASSERT_TRUE(result.complete);
    ASSERT_TRUE(std::is_sorted(result.pairs.begin(), result.pairs.end()));
    ASSERT_EQ(collides(a, world_from_a, b, world_from_b), result.verdict == Verdict::kCollision);
    for (int j = 0; j < 30; ++j) {
      for (int k = 0; k < 20; ++k) {
        const bool found =
            std::binary_search(result.pairs.begin(), result.pairs.end(), SpherePair{j, k});
        const Sphere& sphere = a.spheres()[static_cast<std::size_t>(j)];
        const Real gap =
            exact_distance(sphere, world_from_a, b.triangle(k), world_from_b) - sphere.radius;
        ASSERT_EQ(found, gap <= 0) << gap;
        ASSERT_LE(result.distance_lower_bound, std::max(Real(0), gap));
        hits += found;
      }
    }
  }
  EXPECT_GT(hits, effort(30, 8));
}

TEST(MeshTree, ASphereInsideAClosedMeshDoesNotMeetItsSurface) {
  const MeshTree tetrahedron(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
  EXPECT_FALSE(collides(tree_of({{0.2, 0.2, 0.2}, 0.1}), Pose(), tetrahedron, Pose()));
  EXPECT_TRUE(collides(tree_of({{0.2, 0.2, 0.2}, 0.2}), Pose(), tetrahedron, Pose()));
}

TEST(MeshTree, RefusesAMeshItCannotUse) {
  EXPECT_THROW(MeshTree(TriangleMesh{}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, -1}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, std::nan("")}}, {{0, 0, 0}}}), Error);
  EXPECT_THROW(MeshTree(TriangleMesh{{{0, 0, 0}}, {{0, 0, 0}}, -1.0}), Error);
}

}  // namespace
}  // namespace spherule::test
