// SPDX-License-Identifier: BSD-3-Clause
// What is made of the paper's comparisons: the search for the fewest spheres at equal protrusion
// and figure 2.

#include "bench/paper/equal_protrusion.h"
#include "bench/paper/figure2.h"
#include "tests/support/effort.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace spherule {
namespace {

// A bar, whose inside is found in less time than that of a cube. As many spheres about its middle
// as the reciprocal of the error, with the radius of the one around it, and the error and `more`
// beyond that. The one around it protrudes by kThroughCorners, beside the middle of a long side.
const Eigen::Vector3d kBarSize(1.0, 0.02, 0.02);
const double kHalfDiagonal = 0.5 * kBarSize.norm();
const double kThroughCorners = kHalfDiagonal - 0.01;
SphereMethod concentric(double more) {
  return {"concentric", [more](const TriangleMesh&, double error) {
            return std::vector<Sphere>(static_cast<std::size_t>(std::ceil(1.0 / error)),
                                       {Eigen::Vector3d::Zero(), kHalfDiagonal + more + error});
          }};
}

TEST(FewestSpheres, AreThoseOfAnErrorThatNearlyReachesTheLimit) {
  const double limit = kThroughCorners + 0.15;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(0.0), limit);
  EXPECT_EQ(found.method, "concentric");
  EXPECT_EQ(found.inflation, 0.0);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LE(found.setting, 0.15);
  EXPECT_GE(found.setting, 0.1);
  EXPECT_EQ(found.spheres, static_cast<std::size_t>(std::ceil(1.0 / found.setting)));
}

TEST(FewestSpheres, GrowUntilTheyCover) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const double limit = kThroughCorners + 0.1;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(-0.7), limit);
  EXPECT_GT(found.spheres, 0U);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LT(found.setting, 0.7);
  EXPECT_GE(found.inflation, 0.7 - found.setting);
}

TEST(FewestSpheres, AreNoneWhereNoSettingKeepsToTheLimit) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(1.0), 0.1);
  EXPECT_EQ(found.spheres, 0U);
  EXPECT_GT(found.protrusion, 0.9);
}

TEST(SphereMethods, MakeMoreSpheresForASmallerError) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  std::vector<std::string> names;
  const TriangleMesh cube = make_cube(1.0);
  for (const SphereMethod& method : sphere_methods()) {
    names.push_back(method.name);
    const std::size_t few = method.make(cube, 0.3).size();
    EXPECT_GT(few, 0U) << method.name;
    EXPECT_GT(method.make(cube, 0.12).size(), few) << method.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"packing", "openvdb", "voxels", "octree", "hubbard",
                                             "medial-axis", "paper", "cover-as-is", "cover"}));
}

TEST(Figure2, BoundingSpheresAreFewerThanPackedOnes) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const Figure2 figure = figure_2();
  ASSERT_EQ(figure.fits.size(), 3U);
  EXPECT_LT(figure.fits[1].spheres.size(), figure.fits[0].spheres.size());
  EXPECT_LT(figure.fits[2].spheres.size(), figure.fits[1].spheres.size());
  for (const Figure2::Fit& fit : figure.fits) {
    EXPECT_LE(fit.protrusion, figure.max_error * (1.0 + 1e-9)) << fit.method;
  }
}

}  // namespace
}  // namespace spherule
