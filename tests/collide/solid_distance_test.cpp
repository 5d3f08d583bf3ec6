// SPDX-License-Identifier: BSD-3-Clause
// Spheres so near to a solid mesh that rounding does not tell on which side of it they are.

#include "collide/meshes/solid_mesh.h"
#include "spheretree/build.h"
#include "tests/collide/scene_random.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spherule::test::solid_distance_test {
namespace {

using Eigen::Vector3d;

// Near faces, edges and corners of a box: there rays pass too near to an edge to tell. All numbers
// are multiples of 2^-44 below 2^9, so that sums are exact and the gap is known.
TEST(SolidDistance, BoundsHoldWhereTheInsideIsUncertain) {
  constexpr double kUnit = 0x1p-44;
  const SolidMesh solid(box_mesh({0, 0, 0}, {8, 8, 8}));
  SceneRandom random(11);
  int apart = 0;
  int inside = 0;
  int uncertain = 0;
  for (int i = 0; i < effort(20000, 2000); ++i) {
    Vector3d point(random.whole(1, 7), random.whole(1, 7), random.whole(1, 7));
    const double most = std::ldexp(kUnit, random.whole(0, 14));
    long double squared = 0.0L;
    for (int axis = random.whole(0, 2); axis < 3; ++axis) {
      const double step = std::trunc(random.uniform(-1.0, 1.0) * most / kUnit) * kUnit;
      point[axis] = 8.0 + step;
      if (step > 0.0) squared += static_cast<long double>(step) * step;
    }
    const Vector3d shift(random.whole(-200, 200), random.whole(-200, 200), random.whole(-200, 200));
    const Sphere sphere{point - shift, random.whole(0, 1) == 0 ? 0.0 : random.whole(0, 99) * kUnit};
    const long double exact = std::max(0.0L, std::sqrt(squared) - sphere.radius);
    const DistanceResult found =
        distance(build_tree(std::span(&sphere, 1)), Pose::from_translation(shift), solid, Pose());
    ASSERT_LE(found.lower, exact * (1.0L + 0x1p-60L)) << i;
    ASSERT_GE(found.upper, exact * (1.0L - 0x1p-60L)) << i;
    apart += exact > 0.0L ? 1 : 0;
    inside += found.upper == 0.0 ? 1 : 0;
    uncertain += found.lower == 0.0 && found.upper > 0.0 ? 1 : 0;
  }
  EXPECT_GT(apart, effort(2000, 200));
  EXPECT_GT(inside, effort(200, 20));
  EXPECT_GT(uncertain, effort(200, 20));
}

}  // namespace
}  // namespace spherule::test::solid_distance_test
