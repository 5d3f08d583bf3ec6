// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace spherule::test {
namespace {

SphereCover bounded_cover(const TriangleMesh& mesh, double max_error, double diameter,
                          int rounds = 0) {
  const ExternalSpheres external =
      place_external_spheres(mesh, {.min_external_diameter = diameter, .max_error = max_error});
  return cover(mesh, external, {.max_error = max_error, .effort = rounds, .lower_bound = true});
}

TEST(CoverBound, IsAboveWhatIsEasyAndNeverAboveACover) {
  // A sphere within E of a bar of 1 x 0.01 x 0.01 has a radius of at most E and half the diagonal
  // of its section: it holds no more than twice as much of the length.
  for (const double max_error : {0.12, 0.1, 0.07}) {
    const SphereCover bar = bounded_cover(box_mesh({0, 0, 0}, {1, 0.01, 0.01}), max_error, 1.0);
    EXPECT_GE(static_cast<double>(bar.lower_bound), 1.0 / (2.0 * max_error + 0.01 * 1.4143));
    EXPECT_LE(bar.lower_bound, bar.spheres.size());
  }
  if (kSanitized) return;
  // Of a plate of 1 x 1 x 0.05 it holds a circle of a radius of at most E + 0.025.
  const double max_error = 0.176;
  const SphereCover plate = bounded_cover(box_mesh({0, 0, 0}, {1, 1, 0.05}), max_error, 1.0);
  EXPECT_GE(static_cast<double>(plate.lower_bound),
            1.0 / (std::numbers::pi * std::pow(max_error + 0.025, 2)));
  EXPECT_LE(plate.lower_bound, plate.spheres.size());
  // Any cover of a cube needs a sphere for each of the eight corners: they are 4 E apart, and a
  // sphere reaches 2.83 E along an edge.
  const SphereCover cube = bounded_cover(cube_mesh(), 0.25, 1.0);
  EXPECT_GE(cube.lower_bound, 8U);
  EXPECT_LE(cube.lower_bound, cube.spheres.size());
}

TEST(CoverBound, IsOneWhereOneSphereDoes) {
  const SphereCover cube = bounded_cover(cube_mesh(), 0.5, 2.0, 4);
  EXPECT_EQ(cube.spheres.size(), 1U);
  EXPECT_EQ(cube.lower_bound, 1U);
}

TEST(CoverBound, StaysBelowTheCountOfEveryShape) {
  int above_one = 0;
  for (const auto& [name, mesh] : zoo_to_fit()) {
    SCOPED_TRACE(name);
    const double max_error = 0.3 * diagonal_of(mesh);
    const SphereCover result = bounded_cover(mesh, max_error, 4.0 * max_error);
    EXPECT_GE(result.lower_bound, 1U);
    EXPECT_LE(result.lower_bound, result.spheres.size());
    above_one += result.lower_bound > 1U;
  }
  EXPECT_GT(above_one, 0);
}

TEST(CoverBound, IsEqualOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = l_bracket();
  const double max_error = 0.25 * diagonal_of(mesh);
  const ExternalSpheres external = place_external_spheres(
      mesh, {.min_external_diameter = 4.0 * max_error, .max_error = max_error});
  const auto bound = [&](int threads) {
    return cover(mesh, external,
                 {.max_error = max_error, .effort = 0, .lower_bound = true, .threads = threads})
        .lower_bound;
  };
  const std::size_t alone = bound(1);
  for (const int threads : {0, 3}) EXPECT_EQ(bound(threads), alone);
}

TEST(CoverBound, IsUnknownWhereItWouldNotHold) {
  const TriangleMesh mesh = cube_mesh();
  const ExternalSpheres external =
      place_external_spheres(mesh, {.min_external_diameter = 1.0, .max_error = 0.2});
  EXPECT_EQ(cover(mesh, external, {.max_error = 0.2, .effort = 0}).lower_bound, 0U);
  EXPECT_EQ(
      cover(mesh, external, {.max_error = 0.2, .min_radius = 0.5, .effort = 0, .lower_bound = true})
          .lower_bound,
      0U);
  // An external sphere smaller than E may lie wholly within E of S.
  EXPECT_EQ(cover(mesh, external, {.max_error = 0.6, .effort = 0, .lower_bound = true}).lower_bound,
            1U);
}

}  // namespace
}  // namespace spherule::test
