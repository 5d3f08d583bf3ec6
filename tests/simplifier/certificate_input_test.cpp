// SPDX-License-Identifier: BSD-3-Clause
// What certify() refuses, and what it does not come to an end with unless it does.
#include "base/error.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace spherule::test::certificate_input_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kMiddle = Eigen::Vector3d::Constant(0.5);

std::string refused(const std::vector<Sphere>& spheres, const CertifyOptions& options = {},
                    const TriangleMesh& mesh = cube_mesh()) {
  try {
    certify(mesh, spheres, options);
  } catch (const Error& error) {
    return error.subject();
  }
  return "accepted";
}

TEST(Certificate, BadSpheresAndOptionsAreRefusedByName) {
  const Sphere good{kMiddle, 1.0};
  for (const Sphere& bad :
       {Sphere{kMiddle, kNan}, Sphere{kMiddle, -1e-9}, Sphere{kMiddle, kInfinity},
        Sphere{{0, kNan, 0}, 1.0}, Sphere{{kInfinity, 0, 0}, 1.0}, Sphere{kMiddle, 1e300}}) {
    EXPECT_EQ(refused({good, bad}), "sphere 1");
  }
  for (const double bad : {-1.0, kNan, kInfinity, 2.0}) {
    EXPECT_EQ(refused({good}, {.resolution = bad}), "resolution");
    EXPECT_EQ(refused({good}, {.protrusion_tolerance = bad}), "protrusion tolerance");
  }
  EXPECT_EQ(refused({good}, {.resolution = 0.0}), "resolution");
  for (const double bad : {-1.0, kNan, kInfinity}) {
    EXPECT_EQ(refused({good}, {.padding = bad}), "padding");
  }
  EXPECT_EQ(refused({good}, {}, {}), "mesh");
}

// Without an end if they were not.
TEST(Certificate, ExternalSpheresThatNobodyPlacedAreRefused) {
  const std::vector<Sphere> good{{kMiddle, 1.0}};
  const ExternalSpheres box =
      place_external_spheres(cube_mesh(), {.placement = ExternalPlacement::kNone});
  std::vector<ExternalSpheres> all(8, box);
  all[0] = {};
  all[1].box.min().x() = kNan;
  all[2].box.max().y() = kInfinity;
  all[3].box.max().z() = -1.0;
  all[4].padding = kNan;
  all[5].padding = -1.0;
  all[6].spheres.push_back({{0, kNan, 0}, 1.0});
  all[7].spheres.push_back({{9, 9, 9}, -1.0});
  const auto refused_by = [](const auto& run) -> std::string {
    try {
      run();
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  for (const ExternalSpheres& bad : all) {
    const TriangleMesh mesh = cube_mesh();
    const std::vector<double> levels{0.5};
    EXPECT_EQ(refused_by([&] { certify(mesh, good, {.external = &bad}); }), "external spheres");
    EXPECT_EQ(refused_by([&] { cover(mesh, bad, {.max_error = 0.2}); }), "external spheres");
    EXPECT_EQ(refused_by([&] { repair(mesh, bad, good, {.max_error = 0.2}); }), "external spheres");
    EXPECT_EQ(refused_by([&] { fit_levels(mesh, bad, good, levels, {}); }), "external spheres");
    EXPECT_EQ(refused_by([&] { cover_breakdown(mesh, bad, good, 0.2); }), "external spheres");
    EXPECT_EQ(refused_by([&] { spheres_in_thin_parts(bad, good, 0.2); }), "external spheres");
  }
  const std::vector<Sphere> bad{{kMiddle, kNan}};
  EXPECT_EQ(refused_by([&] { cover_breakdown(cube_mesh(), box, bad, 0.2); }), "sphere 0");
  EXPECT_EQ(refused_by([&] { spheres_in_thin_parts(box, bad, 0.2); }), "sphere 0");
}

// The gap to a sphere that grazes the mesh is known to the rounding of its radius only; halving
// pieces of less never ends.
TEST(Certificate, SpheresOfFarLargerSizeAreRefusedOrExaminedInFewPieces) {
  const auto grazing = [](double radius) { return Sphere{{radius + 0.5, 0.5, 0.5}, radius}; };
  EXPECT_EQ(refused({{kMiddle, 1.0}, grazing(1e15)}), "sphere 1");
  EXPECT_EQ(refused({grazing(0x1p24)}), "sphere 0");
  const ExternalSpheres box =
      place_external_spheres(cube_mesh(), {.placement = ExternalPlacement::kNone});
  CertifyOptions options;
  options.external = &box;
  if (kSanitized) options.protrusion_tolerance = 0.0;  // takes seconds there
  // One that has nothing to do with the mesh does not hide that others cover it.
  EXPECT_TRUE(
      certify(cube_mesh(), std::vector{Sphere{kMiddle, 0.9}, grazing(0x1p22)}, options).covered);
  if (kSanitized) return;
  options.protrusion_tolerance = 0.0;
  const Certificate leak = certify(cube_mesh(), std::vector{grazing(0x1p22)}, options);
  EXPECT_LE(leak.uncovered_depth.lower, 0.5 + 1e-7);  // of the corners at x = 0
  EXPECT_GE(leak.uncovered_depth.upper, 0.5);
  EXPECT_LE(leak.uncovered_depth.upper, 0.52);
  EXPECT_LT(leak.pieces + leak.cells, 500'000U);
}

}  // namespace
}  // namespace spherule::test::certificate_input_test
