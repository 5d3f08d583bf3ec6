// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/fcl_solid.h"

#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

namespace spherule::test {
namespace {

TEST(FclSolid, SeesOneInsideTheOther) {
  const FclSolid big(cube_mesh(10.0)), small(cube_mesh(1.0)), open(open_box());
  const Pose identity, inside = Pose::from_translation({4, 4, 4});
  EXPECT_TRUE(touch(big, identity, small, inside));
  EXPECT_TRUE(touch(small, inside, big, identity));
  EXPECT_TRUE(touch(big, identity, open, inside));
  EXPECT_FALSE(touch(small, Pose::from_translation({-2, 0, 0}), open, identity));
  EXPECT_FALSE(touch(big, identity, small, Pose::from_translation({10.001, 0, 0})));
  // In the wall of a shell, in its sealed hollow and in the core it is not free.
  const FclSolid shells(nested_shells(3)), speck(cube_mesh(1e-3));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.06, 0.06, 0.06})));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.2, 0.2, 0.2})));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.5, 0.5, 0.5})));
}

TEST(FclSolid, ContainsAgreesWithTheShape) {
  const FclSolid sphere(icosphere(3)), turned(inverted(icosphere(3)));
  Random random(2);
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p = random.in_box(cube);
    if (std::abs(p.norm() - 1.0) < 0.02) continue;
    EXPECT_EQ(sphere.contains(p), p.norm() < 1.0);
    EXPECT_EQ(turned.contains(p), p.norm() < 1.0);
  }
}

TEST(FclSolid, Distance) {
  const FclSolid cube(cube_mesh());
  EXPECT_NEAR(surface_distance(cube, Pose(), cube, Pose::from_translation({1.25, 0.5, 0})), 0.25,
              1e-12);
}

}  // namespace
}  // namespace spherule::test
