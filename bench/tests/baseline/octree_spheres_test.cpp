// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/octree_spheres.h"

#include "base/error.h"
#include "bench/tests/baseline/cover_check.h"
#include "geometry/mesh_distance.h"
#include "simplifier/simplify.h"
#include "spheretree/check.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// The tree's parents enclose their children, by long double; its leaves are spheres around cubes.
void expect_layered(const SphereTree& tree) {
  EXPECT_TRUE(check(tree).valid);
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    if (tree.is_leaf(node)) continue;
    const Sphere parent = tree.sphere(node);
    for (std::int32_t k = 0; k < tree.child_count(node); ++k) {
      const Sphere child = tree.sphere(static_cast<std::size_t>(tree.first_child(node) + k));
      ASSERT_LE(judged_distance(parent.center, child.center) + static_cast<Real>(child.radius),
                static_cast<Real>(parent.radius));
      // The method's own sphere around the cube, not one made for the children.
      ASSERT_NEAR(child.radius, parent.radius / 2.0, 1e-4 * child.radius);
    }
  }
}

TEST(OctreeSpheres, CoverAndProtrudeByTheErrorAtMost) {
  Random random(11);
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    for (const double offset : effort(std::vector{1e6, 0.0}, 1)) {
      SCOPED_TRACE(offset);
      const TriangleMesh mesh = moved_far(named.mesh, offset);
      const OctreeSpheres result = octree_spheres(mesh, {.max_error = 0.08 * diagonal_of(mesh)});
      expect_layered(result.tree);
      expect_samples_covered(mesh, result.tree.spheres(), random);
    }
  }
}

TEST(OctreeSpheres, CoverAndProtrudeAsCertified) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const std::string& name :
       effort(std::vector<std::string>{"l-bracket", "soup", "open-box"}, 2)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = moved_far(slender(mesh_named(name)), 1e6);
    const double max_error = 0.02 * diagonal_of(mesh);
    expect_certified(mesh, octree_spheres(mesh, {.max_error = max_error}).tree.spheres(),
                     max_error);
  }
}

TEST(OctreeSpheres, ProtrusionIsProvedOnAWholePart) {
  const TriangleMesh mesh = slender(l_bracket());
  const OctreeSpheres result = octree_spheres(mesh, {.max_error = 0.05});
  const Certificate certificate =
      certify(mesh, result.tree.spheres(),
              {.resolution = 1.0 / 512.0, .protrusion_tolerance = 5e-3, .volume = false});
  // The certificate's bounds are 0.5 % of the diagonal apart.
  EXPECT_LE(certificate.protrusion_over_mesh->upper, 0.06);
  EXPECT_GT(certificate.protrusion_over_mesh->lower, 0.02);
}

TEST(OctreeSpheres, ADepthGivesCubesOfOneSizeOnTheSurface) {
  Random random(12);
  for (const int depth : {1, 3, 5}) {
    SCOPED_TRACE(depth);
    const OctreeSpheres solid = octree_spheres(l_bracket(), {.depth = depth});
    EXPECT_EQ(solid.tree.depth(), depth);
    expect_layered(solid.tree);
    expect_samples_covered(l_bracket(), solid.tree.spheres(), random);
    const OctreeSpheres surface =
        octree_spheres(l_bracket(), {.depth = depth, .filling = Filling::kSurface});
    expect_layered(surface.tree);
    const double radius = surface.tree.spheres().front().radius;
    EXPECT_NEAR(radius, std::sqrt(0.75) * surface.step, 1e-9);
    for (const Sphere& sphere : surface.tree.spheres()) EXPECT_EQ(sphere.radius, radius);
    EXPECT_EQ(
        judge_cover(points_on_surface(l_bracket(), 2000, random), surface.tree.spheres()).uncovered,
        0U);
    EXPECT_LE(surface.tree.spheres().size(), solid.tree.spheres().size());
  }
}

// Large cubes stay whole where they may: far fewer spheres than cubes of the smallest size.
TEST(OctreeSpheres, KeepsLargeCubesInside) {
  const OctreeSpheres result = octree_spheres(icosphere(3), {.max_error = 0.1});
  const auto [least, most] =
      std::minmax_element(result.tree.spheres().begin(), result.tree.spheres().end(),
                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  EXPECT_GE(most->radius, 3.9 * least->radius);
}

TEST(OctreeSpheres, FillsSealedHollows) {
  const TriangleMesh shells = nested_shells(2);
  const OctreeSpheres result = octree_spheres(shells, {.max_error = 0.1});
  const Vector3d middle = MeshDistance(shells).box().center();
  EXPECT_LE(gap_to_spheres(middle, result.tree.spheres()), 0.0L);
  const OctreeSpheres surface =
      octree_spheres(shells, {.max_error = 0.1, .filling = Filling::kSurface});
  EXPECT_GT(gap_to_spheres(middle, surface.tree.spheres()), 0.0L);
}

TEST(OctreeSpheres, Refuses) {
  EXPECT_THROW(octree_spheres(cube_mesh(), {}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = -1}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 21}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 3, .max_error = 0.1}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 15}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.max_error = 1e-4}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.max_error = 0.1, .padding = -0.1}), Error);
  EXPECT_THROW(octree_spheres({}, {.max_error = 0.1}), Error);
  TriangleMesh point;
  point.vertices = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  point.triangles = {{0, 1, 2}};
  EXPECT_THROW(octree_spheres(point, {.depth = 2}), Error);
  EXPECT_EQ(octree_spheres(point, {.max_error = 0.1}).tree.spheres().size(), 1U);
}

}  // namespace
}  // namespace spherule::test
