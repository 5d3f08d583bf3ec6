// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/baseline/made_conservative.h"

#include "spheretree/error.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

TEST(MadeConservative, GrowsByTheUncoveredDepth) {
  const std::vector<Sphere> balls = {{Vector3d::Constant(0.5), 0.5}};
  const ConservativeSpheres result = made_conservative(cube_mesh(), balls);
  ASSERT_EQ(result.spheres.size(), 1U);
  EXPECT_EQ(result.spheres[0].center, balls[0].center);
  EXPECT_TRUE(result.certificate.covered);
  // The corners are at sqrt(3) / 2 from the centre.
  EXPECT_GE(result.spheres[0].radius, 0.8660254);
  EXPECT_LE(result.growth, 0.375);
}

TEST(MadeConservative, LeavesWhatCovers) {
  const std::vector<Sphere> balls = {{Vector3d::Constant(0.5), 0.87}, {Vector3d::Zero(), 0.0}};
  const ConservativeSpheres result = made_conservative(cube_mesh(), balls);
  EXPECT_EQ(result.growth, 0.0);
  EXPECT_EQ(result.spheres, balls);
  EXPECT_TRUE(result.certificate.covered);
}

TEST(MadeConservative, CountsPaddingAndVertexError) {
  const std::vector<Sphere> balls = {{Vector3d::Constant(0.5), 0.87}};
  TriangleMesh mesh = cube_mesh();
  mesh.vertex_error = 0.05;
  const ConservativeSpheres result = made_conservative(mesh, balls, 0.05);
  EXPECT_TRUE(result.certificate.covered);
  EXPECT_GE(result.spheres[0].radius, 0.8660254 + 0.1);
}

TEST(MadeConservative, CoversEveryMeshOfTheZooFromRandomBalls) {
  Random random(7);
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : named.mesh.vertices) box.extend(v);
    std::vector<Sphere> balls(5);
    for (Sphere& ball : balls) {
      ball = {random.in_box(box), random.between(0.0, 0.3) * box.diagonal().norm()};
    }
    const ConservativeSpheres result = made_conservative(named.mesh, balls);
    EXPECT_TRUE(result.certificate.covered) << named.name;
    EXPECT_EQ(judge_cover(points_on_surface(named.mesh, 2000, random), result.spheres).uncovered,
              0U)
        << named.name;
  }
}

TEST(MadeConservative, RefusesWhatCannotGrow) {
  EXPECT_THROW(made_conservative(cube_mesh(), {}), Error);
  const std::vector<Sphere> bad = {{Vector3d::Zero(), -1.0}};
  EXPECT_THROW(made_conservative(cube_mesh(), bad), Error);
  const std::vector<Sphere> good = {{Vector3d::Zero(), 1.0}};
  EXPECT_THROW(made_conservative(cube_mesh(), good, -1.0), Error);
}

}  // namespace
}  // namespace spherule::test
