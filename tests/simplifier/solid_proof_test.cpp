// SPDX-License-Identifier: BSD-3-Clause
// What bounds the proof of S, G1, has to take from external spheres: cells are few where spheres
// end close to a curved surface.
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// All vertices are equally far out: a bound by the size of cells alone needs millions of cells.
TEST(SolidProof, ALeakAllOverASurfaceIsBoundedInFewCells) {
  const TriangleMesh mesh = icosphere(2);
  const ExternalSpheres external = place_external_spheres(mesh, {.min_external_diameter = 0.5});
  CertifyOptions options;
  options.external = &external;
  const Certificate leak = certify(mesh, std::vector<Sphere>{{Vector3d::Zero(), 0.95}}, options);
  EXPECT_NEAR(leak.surface_depth.lower, 0.05, 1e-9);
  EXPECT_NEAR(leak.surface_depth.upper, 0.05, 1e-9);
  EXPECT_EQ(leak.solid_depth.lower, leak.surface_depth.lower);
  EXPECT_LE(leak.solid_depth.upper, 0.052);
  EXPECT_LE(leak.pieces, 2U * mesh.triangles.size());
  EXPECT_LE(leak.cells, 100'000U);
}

// The sphere holds the middles of all facets.
TEST(SolidProof, ALeakAtVerticesOnlyIsWitnessed) {
  const TriangleMesh mesh = icosphere(2);
  const ExternalSpheres external = place_external_spheres(mesh, {.min_external_diameter = 0.5});
  CertifyOptions options;
  options.external = &external;
  for (const double depth : effort(std::vector{1e-5, 1e-3, 1e-8}, 1)) {
    const std::vector<Sphere> sphere{{Vector3d::Zero(), 1.0 - depth}};
    const Certificate leak = certify(mesh, sphere, options);
    EXPECT_NEAR(leak.uncovered_depth.lower, depth, 1e-12);
    EXPECT_NEAR(leak.surface_depth.upper, depth, 1e-12);
    EXPECT_NEAR(leak.deepest_leak.norm(), 1.0, 1e-12);
  }
}

// What external spheres leave is nearly a sphere, covered by one that is hardly larger.
TEST(SolidProof, ASphereThatHardlyExceedsTheSolidIsProvedInFewCells) {
  ExternalSpheres external;
  external.box = {Vector3d::Constant(-1), Vector3d::Constant(1)};
  Random random(37);
  for (int i = 0; i < 2000; ++i) external.spheres.push_back({random.direction(), 0.75});
  CertifyOptions options;
  options.external = &external;
  const TriangleMesh mesh = box_mesh(Vector3d::Constant(-0.1), Vector3d::Constant(0.1));
  const Certificate tight = certify(mesh, std::vector<Sphere>{{Vector3d::Zero(), 0.26}}, options);
  EXPECT_TRUE(tight.covered);
  EXPECT_LE(tight.cells, 10'000U);
}

// What external spheres take away of the mesh is not of S, and no witness against it.
TEST(SolidProof, BoundsAreInOrderWhereExternalSpheresPierceTheMesh) {
  const TriangleMesh cube = box_mesh({0, 0, 0}, {1, 1, 1});
  ExternalSpheres external = place_external_spheres(cube, {.placement = ExternalPlacement::kNone});
  external.spheres.push_back({{0.5, 0.5, 10.0}, 9.5});
  CertifyOptions options;
  options.external = &external;
  const Vector3d bottom(0.5, 0.5, 0.0);
  // Up to where the external sphere crosses the vertical edges of the cube.
  const double edge = 10.0 - std::sqrt(9.5 * 9.5 - 0.5);
  const double radius = std::sqrt(0.5 + edge * edge) + 1e-5;
  const Certificate pierced = certify(cube, std::vector<Sphere>{{bottom, radius}}, options);
  EXPECT_EQ(pierced.solid_depth.lower, 0.0);
  EXPECT_LE(pierced.solid_depth.upper, 1e-3);
  EXPECT_GT(pierced.surface_depth.lower, 0.1);
}

}  // namespace
}  // namespace spherule::test
