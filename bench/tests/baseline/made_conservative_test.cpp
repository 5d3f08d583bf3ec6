// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/made_conservative.h"

#include "base/error.h"
#include "bench/tests/baseline/cover_check.h"
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

}  // namespace
}  // namespace spherule::test
