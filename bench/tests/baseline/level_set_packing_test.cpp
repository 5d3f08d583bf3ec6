// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/level_set_packing.h"

#include "base/error.h"
#include "geometry/mesh_distance.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test {
namespace {

// Judged by the distance to the mesh and the winding number. A sphere about a point of the level
// set reaches at most a step beyond the surface.
TEST(LevelSetPacking, FillsTheSolidWithSpheresInsideOfIt) {
  constexpr double kStep = 0.5;
  const TriangleMesh mesh = pipe(20.0, 14.0, 60.0, 40);
  const std::vector<Sphere> spheres =
      level_set_packing(mesh, {.step = kStep, .min_radius = 1.0, .max_spheres = 400});
  EXPECT_GT(spheres.size(), 50U);
  EXPECT_LE(spheres.size(), 400U);
  const MeshDistance distance(mesh);
  for (const Sphere& sphere : spheres) {
    EXPECT_NE(std::round(distance.winding_number(sphere.center)), 0.0);
    EXPECT_LE(sphere.radius, distance(sphere.center).upper + kStep);
    EXPECT_GE(sphere.radius, 1.0 - 1e-3);
  }
}

TEST(LevelSetPacking, IsTheSameWhereverTheMeshIsAndOnAnyNumberOfThreads) {
  TriangleMesh mesh = cube_mesh();
  const LevelSetPackingOptions options{.step = 0.0625, .max_spheres = 100, .threads = 1};
  const std::vector<Sphere> spheres = level_set_packing(mesh, options);
  EXPECT_EQ(level_set_packing(mesh, {.step = 0.0625, .max_spheres = 100}), spheres);
  const Eigen::Vector3d shift(4096.0, -8192.0, 0.0);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = 1024.0 * vertex + shift;
  const std::vector<Sphere> larger = level_set_packing(mesh, {.step = 64.0, .max_spheres = 100});
  ASSERT_EQ(larger.size(), spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    EXPECT_EQ(larger[i].radius, 1024.0 * spheres[i].radius);
    EXPECT_EQ(larger[i].center, 1024.0 * spheres[i].center + shift);
  }
}

TEST(LevelSetPacking, MakesNoSphereThatIsTooSmall) {
  EXPECT_TRUE(level_set_packing(cube_mesh(), {.step = 0.05, .min_radius = 0.6}).empty());
}

TEST(LevelSetPacking, RefusesBadInput) {
  const TriangleMesh mesh = cube_mesh();
  EXPECT_THROW(level_set_packing({}, {.step = 0.1}), Error);
  EXPECT_THROW(level_set_packing(mesh, {}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = 1e-4}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = 0.1, .threads = -1}), Error);
  TriangleMesh point = mesh;
  for (Eigen::Vector3d& vertex : point.vertices) vertex = {1, 1, 1};
  EXPECT_THROW(level_set_packing(point, {}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = std::nan("")}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = 0.1, .min_radius = -1.0}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = 0.1, .max_spheres = 0}), Error);
  EXPECT_THROW(level_set_packing(mesh, {.step = 0.1, .candidates = 0}), Error);
}

}  // namespace
}  // namespace spherule::test
