// SPDX-License-Identifier: BSD-3-Clause
// Spheres and triangles that come within a clearance, against 100 digits.

#include "collide/meshes/mesh_search.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test::mesh_within_test {
namespace {

using Eigen::Vector3d;

SphereTree tree_of(const Sphere& sphere) {
  return build_tree(std::span(&sphere, 1));
}

// Needles and triangles next to the clearance: every kernel says what the test of the pair says,
// and that is right.
TEST(MeshTreeTest, KernelsAgreeWithinAClearance) {
  SceneRandom random(6);
  int counts[2] = {};
  for (int i = 0; i < effort(700, 60); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 17));
    const double thin = random.whole(0, 2) == 0 ? 1e-7 : 1.0;
    const std::array<Vector3d, 3> t = {random.point(size), random.point(size), random.point(size)};
    const Vector3d third = t[0] + random.uniform(0.0, 1.0) * (t[1] - t[0]) + thin * t[2];
    const MeshTree mesh(TriangleMesh{{t[0], t[1], third}, {{0, 1, 2}}});
    const Pose world_from_a = random.pose(size);
    const Pose world_from_b = random.pose(size);
    Sphere sphere{random.point(size), 0.0};
    const Real distance =
        sqrt(squared_distance_to_triangle(transform(world_from_a, exact<Real>(sphere.center)),
                                          placed<Real>(world_from_b, mesh.triangle(0))));
    const double steps[] = {0.0, 1e-15, 1e-14, 1e-12, 1e-9, 1e-7, 1e-6, 0.1};
    const double way = distance.convert_to<double>() *
                       (1.0 + random.uniform(-1.0, 1.0) * steps[random.whole(0, 7)]);
    sphere.radius = random.whole(0, 1) * random.uniform(0.0, 1.0) * way;
    const double clearance = way - sphere.radius;
    const SphereTree tree = tree_of(sphere);
    const internal::RelativePose pose(tree, world_from_a, mesh.tree(), world_from_b);
    const bool expected =
        internal::TriangleLeaves(tree, mesh, pose, clearance).touches(std::int32_t{0}, 0);
    ASSERT_TRUE(expected || distance > Real(sphere.radius) + clearance) << i;
    for (const InstructionSet set : instruction_sets()) {
      ASSERT_EQ(internal::collides_by(internal::mesh_kernel_for(set), tree, world_from_a, mesh,
                                      world_from_b, clearance),
                expected)
          << i;
    }
    ++counts[expected];
  }
  EXPECT_GT(counts[0], effort(150, 10));
  EXPECT_GT(counts[1], effort(150, 10));
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
}  // namespace spherule::test::mesh_within_test
