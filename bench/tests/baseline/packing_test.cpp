// SPDX-License-Identifier: BSD-3-Clause
// Packings, and spheres of any method made conservative.
#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/tests/baseline/cover_check.h"
#include "geometry/mesh_distance.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// Long and thin: its corners are at the square root of 64.5 from its middle.
const TriangleMesh kBar = slender(cube_mesh(16.0));
const Vector3d kMiddle(8.0, 0.5, 0.5);
const double kToCorner = std::sqrt(64.5);

TEST(MadeConservative, GrowsByTheUncoveredDepth) {
  const std::vector<Sphere> spheres = {{kMiddle, kToCorner - 2.0}};
  const ConservativeSpheres result = made_conservative(kBar, spheres);
  ASSERT_EQ(result.spheres.size(), 1U);
  EXPECT_EQ(result.spheres[0].center, spheres[0].center);
  EXPECT_TRUE(result.certificate.covered);
  EXPECT_GE(result.spheres[0].radius, kToCorner);
  EXPECT_LE(result.inflation, 2.05);
}

TEST(MadeConservative, LeavesWhatCovers) {
  const std::vector<Sphere> spheres = {{kMiddle, kToCorner + 0.05}, {Vector3d::Zero(), 0.0}};
  const ConservativeSpheres result = made_conservative(kBar, spheres);
  EXPECT_EQ(result.inflation, 0.0);
  EXPECT_EQ(result.spheres, spheres);
  EXPECT_TRUE(result.certificate.covered);
}

TEST(MadeConservative, CountsPaddingAndVertexError) {
  const std::vector<Sphere> spheres = {{kMiddle, kToCorner + 0.04}};
  TriangleMesh mesh = kBar;
  mesh.vertex_error = 0.05;
  const ConservativeSpheres result = made_conservative(mesh, spheres, 0.05);
  EXPECT_TRUE(result.certificate.covered);
  EXPECT_GE(result.spheres[0].radius, kToCorner + 0.1);
}

TEST(MadeConservative, CoversMeshesOfEveryKindFromRandomSpheres) {
  Random random(7);
  // Solid, open, self-intersecting, with hollows, and closed without an inside.
  for (const std::string& name :
       effort(std::vector<std::string>{"l-bracket", "three-fins", "needles", "soup", "open-box",
                                       "nested-shells", "projective-plane"},
              2)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = slender(mesh_named(name));
    const Eigen::AlignedBox3d box = MeshDistance(mesh).box();
    std::vector<Sphere> spheres(5);
    for (Sphere& sphere : spheres) {
      sphere = {random.in_box(box), random.between(0.0, 0.3) * box.diagonal().norm()};
    }
    const ConservativeSpheres result = made_conservative(mesh, spheres);
    EXPECT_TRUE(result.certificate.covered);
    expect_samples_covered(mesh, result.spheres, random);
  }
}

TEST(MadeConservative, RefusesWhatCannotGrow) {
  EXPECT_THROW(made_conservative(cube_mesh(), {}), Error);
  const std::vector<Sphere> bad = {{Vector3d::Zero(), -1.0}};
  EXPECT_THROW(made_conservative(cube_mesh(), bad), Error);
  const std::vector<Sphere> good = {{Vector3d::Zero(), 1.0}};
  EXPECT_THROW(made_conservative(cube_mesh(), good, -1.0), Error);
}

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

TEST(PackSpheres, StaysInsideAndCoversWhenInflated) {
  Random random(21);
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    const TriangleMesh mesh = slender(named.mesh);
    const double max_error = 0.04 * diagonal_of(mesh);
    const SpherePacking packing =
        pack_spheres(mesh, {.max_error = max_error, .closed_below = max_error});
    ASSERT_FALSE(packing.spheres.empty());
    ASSERT_EQ(packing.inflated.size(), packing.spheres.size());
    EXPECT_LE(packing.error, max_error);
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      EXPECT_EQ(packing.inflated[i].center, packing.spheres[i].center);
      EXPECT_NEAR(packing.inflated[i].radius, packing.spheres[i].radius + packing.error,
                  1e-12 * max_error);
    }
    const ProtrusionJudgement raw =
        judge_protrusion(packing.spheres, mesh, packing.solid, 1e-6 * max_error, 5, random);
    EXPECT_EQ(raw.beyond, 0U) << raw.example.transpose();
    std::vector<Vector3d> points =
        points_of_solid(packing.solid, static_cast<std::size_t>(effort(1000, 200)), random);
    EXPECT_EQ(judge_cover(points, packing.inflated).uncovered, 0U);
    EXPECT_LE(judge_cover(points, packing.spheres).depth, static_cast<Real>(max_error));
    points = points_on_surface(mesh, static_cast<std::size_t>(effort(1000, 200)), random);
    EXPECT_EQ(judge_cover(points, packing.inflated).uncovered, 0U);
  }
}

TEST(PackSpheres, HoldsPaddingAndVertexErrorWhenInflated) {
  TriangleMesh mesh = cube_mesh();
  mesh.vertex_error = 0.05;
  const SpherePacking packing = pack_spheres(mesh, {.max_error = 0.2, .padding = 0.1});
  expect_inflated_covered(mesh, 0.1499, 1000, packing.inflated, 22);
}

TEST(PackSpheres, PacksTheWallOfAPipeAndNotItsBore) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = pipe(20.0, 14.0, 25.0, 24);
  const SpherePacking packing = pack_spheres(mesh, {.max_error = 2.0, .closed_below = 4.0});
  for (const Sphere& sphere : packing.spheres) {
    EXPECT_GT(std::hypot(sphere.center.x(), sphere.center.y()), 14.0 - 1.0);
    EXPECT_LE(sphere.radius, 3.5);
  }
  const Certificate certificate = certify(mesh, packing.inflated, {.external = &packing.solid});
  EXPECT_TRUE(certificate.covered);
  EXPECT_LE(*certificate.protrusion_over_simplified_max, 2.0);
  // The paper's figure 2: what the simplification closes, it need not follow.
  const Simplification simplified = simplify(
      mesh, {.max_error = 2.0, .min_external_diameter = 40.0, .method = CoverMethod::kPaper});
  EXPECT_LT(simplified.cover.spheres.size(), packing.spheres.size());
}

TEST(PackSpheres, HistoryTellsErrorAgainstCount) {
  const SpherePacking packing = pack_spheres(
      pipe(20.0, 14.0, 25.0, 24), {.max_error = 2.0, .closed_below = 4.0, .history = true});
  ASSERT_GE(packing.history.size(), 10U);
  EXPECT_EQ(packing.history.back().sphere_count, packing.spheres.size());
  for (std::size_t i = 1; i < packing.history.size(); ++i) {
    EXPECT_GT(packing.history[i].sphere_count, packing.history[i - 1].sphere_count);
    EXPECT_GE(packing.history[i].coverage_before, packing.history[i - 1].coverage_before);
    EXPECT_LE(packing.history[i].surface_error_before, packing.history[i - 1].surface_error_before);
  }
  EXPECT_LE(packing.history.back().max_error_upper, 2.0);
  EXPECT_LT(packing.history.back().coverage_before, 1.0);
  EXPECT_EQ(packing.history.back().coverage_after, 1.0);
}

TEST(PackSpheres, IsTheSameOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const SpherePacking one = pack_spheres(l_bracket(), {.max_error = 0.1, .threads = 1});
  const SpherePacking two = pack_spheres(l_bracket(), {.max_error = 0.1, .threads = 2});
  EXPECT_EQ(one.spheres, two.spheres);
  EXPECT_EQ(one.error, two.error);
}

TEST(PackSpheres, Refuses) {
  EXPECT_THROW(pack_spheres(cube_mesh(), {}), Error);
  EXPECT_THROW(pack_spheres(cube_mesh(), {.max_error = -1.0}), Error);
  EXPECT_THROW(pack_spheres(cube_mesh(), {.max_error = 0.1, .seed_diameter = -1.0}), Error);
  EXPECT_THROW(pack_spheres(cube_mesh(), {.max_error = 0.1, .closed_below = -1.0}), Error);
  EXPECT_THROW(pack_spheres(cube_mesh(), {.max_error = 0.1, .padding = -1.0}), Error);
  EXPECT_THROW(pack_spheres({}, {.max_error = 0.1}), Error);
}

}  // namespace
}  // namespace spherule::test
