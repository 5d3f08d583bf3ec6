// SPDX-License-Identifier: BSD-3-Clause
// Which pairs are reported does not depend on the trees above them (G7), and least of all near
// contact, where the pads decide: spheres against spheres, against triangles, and against needles,
// whose distance in double is loose.

#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/nearest_first.h"
#include "collide/search/queries.h"
#include "spheretree/build.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spherule::test {
namespace {

// What a search without any pruning reports.
template <class LeafTest>
std::vector<SpherePair> pairs_without_pruning(const SphereTree& a, const SphereTree& b,
                                              const internal::RelativePose& pose,
                                              const LeafTest& test) {
  const CollisionRequest request;
  CollisionResult result;
  internal::CollectPairs query(test, a, b, request, result);
  EXPECT_TRUE(internal::traverse_exhaustively(a, b, internal::TreePair(a, b, pose), query));
  std::sort(result.pairs.begin(), result.pairs.end());
  return result.pairs;
}

constexpr int kSpheres = 24;

TEST(SamePairs, OfSpheresForEveryTree) {
  SceneRandom random(2);
  std::size_t pairs = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<Sphere> first = random_spheres(random, kSpheres, 10.0, 0.1);
    const Eigen::Quaterniond turned = random.quaternion();
    const Pose world_from_b(turned, random.point(1.0));
    const Pose world_from_a;
    const Pose b_from_a = world_from_b.inverse();
    // Beside each sphere one of the other set, at a gap of a share of the slack.
    std::vector<Sphere> second;
    for (const Sphere& sphere : first) {
      const double radius = random.uniform(0.01, 0.1);
      const double gap = random.uniform(-1e-13, 4e-13);
      const Eigen::Vector3d direction = random.point(1.0).normalized();
      second.push_back(
          {b_from_a * (sphere.center + (sphere.radius + radius + gap) * direction), radius});
    }
    std::vector<SpherePair> expected;
    for (const int branching : {2, 8, 16}) {
      const SphereTree a = build_tree(first, {.branching = branching});
      const SphereTree b = build_tree(second, {.branching = branching});
      const internal::RelativePose pose(a, world_from_a, b, world_from_b);
      const auto all = pairs_without_pruning(a, b, pose, internal::SphereLeaves(a, b, pose));
      if (branching == 2) expected = all;
      ASSERT_EQ(all, expected) << "branching " << branching;
      ASSERT_EQ(collide(a, world_from_a, b, world_from_b).pairs, expected)
          << "branching " << branching;
    }
    pairs += expected.size();
  }
  EXPECT_GT(pairs, 2000u);
  EXPECT_LT(pairs, 8000u);
}

constexpr int kTriangles = kSpheres;

// Triangles far apart from each other; needles where `thin` is small.
TriangleMesh scattered_triangles(SceneRandom& random, double thin) {
  TriangleMesh mesh;
  for (int i = 0; i < kTriangles; ++i) {
    const Eigen::Vector3d a = random.point(10.0);
    const Eigen::Vector3d edge = random.point(1.0);
    const double share = random.uniform(0.0, 1.0);
    mesh.vertices.insert(mesh.vertices.end(), {a, a + edge, a + share * edge + random.point(thin)});
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

// A sphere beyond the first corner of every triangle, seen from the middle of the leaf's sphere, so
// that the gaps to the triangle and to the leaf's sphere are the same. Gaps of 1e-16 to 1e-9, of
// both signs.
std::vector<Sphere> spheres_at_corners(SceneRandom& random, const MeshTree& mesh,
                                       const Pose& a_from_b) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < kTriangles; ++i) {
    const Sphere leaf = mesh.tree().spheres()[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& corner = mesh.triangle(i)[0];
    const double sign = random.whole(0, 3) == 0 ? -1.0 : 1.0;
    const double mantissa = random.uniform(0.1, 1.0);
    const double gap = sign * mantissa * std::pow(10.0, random.whole(-15, -9));
    const double radius = random.uniform(0.01, 0.1);
    const Eigen::Vector3d outwards = (corner - leaf.center).normalized();
    spheres.push_back({a_from_b * (corner + (radius + gap) * outwards), radius});
  }
  return spheres;
}

void compare_trees(double thin) {
  SceneRandom random(3);
  std::size_t pairs = 0;
  for (int i = 0; i < 100; ++i) {
    const MeshTree mesh(scattered_triangles(random, thin));
    const Pose world_from_a(random.quaternion(), Eigen::Vector3d::Zero());
    const Eigen::Quaterniond turned = random.quaternion();
    const Pose world_from_b(turned, random.point(1.0));
    const std::vector<Sphere> spheres =
        spheres_at_corners(random, mesh, world_from_a.inverse() * world_from_b);
    std::vector<SpherePair> expected;
    for (const int branching : {2, 8, 16}) {
      const SphereTree a = build_tree(spheres, {.branching = branching});
      const internal::RelativePose pose(a, world_from_a, mesh.tree(), world_from_b);
      const auto all =
          pairs_without_pruning(a, mesh.tree(), pose, internal::TriangleLeaves(a, mesh, pose));
      if (branching == 2) expected = all;
      ASSERT_EQ(all, expected) << "branching " << branching;
      const CollisionResult result = collide(a, world_from_a, mesh, world_from_b);
      ASSERT_TRUE(result.complete);
      ASSERT_EQ(result.pairs, expected) << "branching " << branching;
      ASSERT_EQ(collides(a, world_from_a, mesh, world_from_b), !expected.empty());
      // What is accepted must be a pair that the node tests are proved to keep.
      for (const SpherePair& pair : all) {
        ASSERT_TRUE(pose.touches(a.spheres()[static_cast<std::size_t>(pair.a)],
                                 mesh.tree().spheres()[static_cast<std::size_t>(pair.b)]));
      }
    }
    pairs += expected.size();
  }
  EXPECT_GT(pairs, 600u);
  EXPECT_LT(pairs, 2000u);
}

TEST(SamePairs, OfTrianglesForEveryTree) {
  compare_trees(1.0);
}
TEST(SamePairs, OfNeedlesForEveryTree) {
  compare_trees(1e-9);
}
TEST(SamePairs, OfDegenerateTrianglesForEveryTree) {
  compare_trees(0.0);
}

}  // namespace
}  // namespace spherule::test
