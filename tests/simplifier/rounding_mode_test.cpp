// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/rounding_mode.h"

#include "simplifier/repair.h"
#include "simplifier/simplify.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

namespace spherule::test::simplifier_rounding_mode_test {
namespace {

// Whatever a fit or an audit consists of is refused where it is called by itself, too.
TEST(RoundingMode, OthersAreRefusedByEveryStage) {
  const TriangleMesh cube = cube_mesh();
  const ExternalSpheres external = place_external_spheres(cube, {.min_external_diameter = 4.0});
  const SphereCover few = cover(cube, external, {.max_error = 1.0, .effort = 0});
  expect_rounding_to_nearest_is_needed(
      [&] { place_external_spheres(cube, {.min_external_diameter = 4.0}); }, "stage 1");
  expect_rounding_to_nearest_is_needed(
      [&] { cover(cube, external, {.max_error = 1.0, .effort = 0}); }, "cover");
  expect_rounding_to_nearest_is_needed(
      [&] { repair(cube, external, few.spheres, {.max_error = 1.0, .effort = 0}); }, "repair");
  expect_rounding_to_nearest_is_needed([&] { certify(cube, few.spheres, {.external = &external}); },
                                       "certify");
}

}  // namespace
}  // namespace spherule::test::simplifier_rounding_mode_test
