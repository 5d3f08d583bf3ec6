// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/packing_cover.h"
#include "bench/tests/baseline/cover_check.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

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
