// SPDX-License-Identifier: BSD-3-Clause
// Input that no stage takes, refused by the name of what is wrong.
#include "simplifier/cover_breakdown.h"
#include "simplifier/leaks.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/rounding_mode.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Spheres = std::vector<Sphere>;

const TriangleMesh kCube = cube_mesh();
const Spheres kGood{{Vector3d::Constant(0.5), 1.0}};

// With one field changed.
template <class Options, class Value>
Options with(Options options, Value Options::*field, Value value) {
  options.*field = value;
  return options;
}

std::string of_simplify(const SimplifyOptions& options, const TriangleMesh& mesh = kCube) {
  return refused([&] { simplify(mesh, options); });
}

std::string of_external(const ExternalOptions& options, const TriangleMesh& mesh = kCube) {
  return refused([&] { place_external_spheres(mesh, options); });
}

std::string of_certify(const Spheres& spheres, const CertifyOptions& options = {}) {
  return refused([&] { certify(kCube, spheres, options); });
}

// Neither of one triangle nor of finite coordinates nor of vertices that are there.
std::vector<TriangleMesh> bad_meshes() {
  std::vector<TriangleMesh> meshes(3, kCube);
  meshes[0] = {};
  meshes[1].triangles[0][1] = 8;
  meshes[2].vertices[3].y() = kNan;
  return meshes;
}

TEST(Refusals, OfMeshes) {
  for (const TriangleMesh& mesh : bad_meshes()) {
    EXPECT_EQ(of_simplify({.max_error = 0.2}, mesh), "mesh");
    EXPECT_EQ(of_external({.min_external_diameter = 0.5}, mesh), "mesh");
  }
  EXPECT_EQ(refused([&] { certify({}, kGood, {}); }), "mesh");
  EXPECT_THROW(leak_points({}, kGood), Error);
  EXPECT_THROW(leak_surface({}, kGood), Error);
}

TEST(Refusals, OfOptionsOfAFit) {
  const SimplifyOptions good{.max_error = 0.2, .effort = 1};
  for (const double bad : {-1.0, kNan, kInfinity}) {
    for (const auto& [field, name] :
         {std::pair{&SimplifyOptions::max_error, "max error"},
          {&SimplifyOptions::min_external_diameter, "min external diameter"},
          {&SimplifyOptions::padding, "padding"},
          {&SimplifyOptions::min_radius, "min radius"},
          {&SimplifyOptions::min_internal_diameter, "min internal diameter"}}) {
      EXPECT_EQ(of_simplify(with(good, field, bad)), name) << bad;
    }
  }
  const auto levels = [&](double max_error, const std::vector<double>& requested) {
    return refusal([&] { simplify(kCube, {.max_error = max_error, .levels = requested}); });
  };
  for (const double bad : {0.0, -0.1, kNan, 1e300}) {
    EXPECT_NE(levels(0.0, {0.1, bad}).find("levels: must be positive"), std::string::npos) << bad;
  }
  EXPECT_NE(levels(0.1, {0.2, 0.05}).find("finer than the max error"), std::string::npos);
  EXPECT_NE(levels(0.1, {0.2, 0.2001}).find("1 % larger"), std::string::npos);
}

TEST(Refusals, OfZones) {
  const Zone zone{.shape = Sphere{{0, 0, 0}, 1.0}, .max_error = 0.05, .min_external_diameter = 0.1};
  const SimplifyOptions good{.max_error = 0.1, .zones = {zone}};
  EXPECT_EQ(of_simplify(with(good, &SimplifyOptions::method, CoverMethod::kPaper)), "zones");
  EXPECT_EQ(of_simplify(with(good, &SimplifyOptions::external, ExternalPlacement::kRandom)),
            "zones");
  for (const Zone& bad : {Zone{.shape = zone.shape, .max_error = 0.2},
                          Zone{.shape = zone.shape, .min_external_diameter = 0.5},
                          Zone{.shape = zone.shape, .max_error = kNan},
                          Zone{.shape = zone.shape, .min_external_diameter = kNan},
                          Zone{.shape = Sphere{{0, 0, 0}, kNan}, .max_error = 0.05}}) {
    EXPECT_EQ(of_simplify(with(good, &SimplifyOptions::zones, {zone, bad})), "zone 1");
    EXPECT_THROW(check_zones(std::vector{bad}, 0.1, 0.4), Error);
  }
  EXPECT_NO_THROW(check_zones(good.zones, 0.05, 0.1));
  for (const double bad : {1.0, 1e-300}) {
    const Zone of_d{.shape = zone.shape, .min_external_diameter = bad};
    EXPECT_NE(of_external({.min_external_diameter = 0.5, .zones = {of_d}}), "accepted") << bad;
  }
  for (const ExternalPlacement placement : {ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
    const ExternalOptions options{.placement = placement, .min_external_diameter = 0.5};
    EXPECT_NE(of_external(with(options, &ExternalOptions::zones, {zone})), "accepted");
    EXPECT_NE(of_external(with(options, &ExternalOptions::keep_concave_edges, true)), "accepted");
  }
}

TEST(Refusals, OfOptionsOfStage1) {
  const std::string diameter = "min external diameter";
  const ExternalOptions good{.min_external_diameter = 0.5};
  for (const ExternalPlacement placement :
       {ExternalPlacement::kReachable, ExternalPlacement::kRandom}) {
    const ExternalOptions options = with(good, &ExternalOptions::placement, placement);
    for (const double bad : {-1.0, kNan, kInfinity, 0.0, 1e300}) {
      EXPECT_EQ(of_external(with(options, &ExternalOptions::min_external_diameter, bad)), diameter);
      if (bad == 0.0 || bad == 1e300) continue;
      EXPECT_EQ(of_external(with(options, &ExternalOptions::padding, bad)), "padding") << bad;
    }
  }
  for (const double bad : {-1.0, kNan, 1e-12, kInfinity}) {
    EXPECT_EQ(of_external(with(good, &ExternalOptions::grid_step, bad)), "grid step") << bad;
  }
  for (const double bad : {0.0, -1.0, 11.0, kNan}) {
    EXPECT_NE(of_external(with(good, &ExternalOptions::tightness, bad)), "accepted") << bad;
  }
  for (const std::size_t bad : {std::size_t{0}, ExternalOptions::kMostCells + 1}) {
    EXPECT_EQ(of_external(with(good, &ExternalOptions::max_cells, bad)), "max cells") << bad;
  }
  EXPECT_EQ(of_external({.min_external_diameter = 1e-9}), "grid step");
  // The search would not end in a mesh of such a size.
  for (const double bad : {5e-324, 0.9e-60}) {
    const TriangleMesh tiny = box_mesh(Vector3d::Zero(), Vector3d::Constant(10.0 * bad));
    EXPECT_EQ(of_external({.min_external_diameter = bad}, tiny), diameter) << bad;
  }
}

TEST(Refusals, OfOptionsOfStage2AndOfRepair) {
  const ExternalSpheres external = externals_of(kCube, {});
  for (const CoverMethod method : {CoverMethod::kCover, CoverMethod::kPaper}) {
    const CoverOptions good{.method = method, .max_error = 0.3, .effort = 0};
    const auto of_cover = [&](double CoverOptions::*field, double value) {
      return refused([&] { cover(kCube, external, with(good, field, value)); });
    };
    for (const double bad : {-1.0, kNan, kInfinity, 1e300}) {
      EXPECT_EQ(of_cover(&CoverOptions::max_error, bad), "max error");
      EXPECT_EQ(of_cover(&CoverOptions::min_radius, bad), "min radius");
      EXPECT_EQ(of_cover(&CoverOptions::min_internal_diameter, bad), "min internal diameter");
    }
    EXPECT_EQ(of_cover(&CoverOptions::max_error, 0.0), "max error");
    EXPECT_EQ(of_cover(&CoverOptions::max_error, 0.3), "accepted");
  }
  const auto of_repair = [&](const RepairOptions& options, const Spheres& spheres = {}) {
    return refused([&] { repair(kCube, external, spheres, options); });
  };
  for (const double bad : {-1.0, kNan, 1e300, 1e-17}) {
    EXPECT_NE(of_repair({.max_error = bad}), "accepted") << bad;
  }
  EXPECT_NE(of_repair({.max_error = 0.1}, {{Vector3d::Zero(), kNan}}), "accepted");
  EXPECT_NE(of_repair({.max_error = 0.1, .effort = -1}), "accepted");
  for (const Zone& bad : {Zone{.shape = Sphere{Vector3d::Zero(), -20.0}, .max_error = 0.05},
                          Zone{.shape = Sphere{Vector3d::Zero(), 1.0}, .max_error = kNan}}) {
    EXPECT_NE(of_repair({.max_error = 0.1, .zones = {bad}}), "accepted");
  }
  for (const double bad : {0.0, -1.0, kNan, 1e300}) {
    EXPECT_THROW(cover_breakdown(kCube, external, {}, bad), Error) << bad;
  }
  EXPECT_THROW(spheres_in_thin_parts({}, {}, 0.0), Error);
}

TEST(Refusals, OfSpheresAndOptionsOfProofs) {
  const Vector3d middle = kGood[0].center;
  for (const Sphere& bad :
       {Sphere{middle, kNan}, Sphere{middle, -1e-9}, Sphere{middle, kInfinity},
        Sphere{{0, kNan, 0}, 1.0}, Sphere{{kInfinity, 0, 0}, 1.0}, Sphere{middle, 1e300}}) {
    EXPECT_EQ(of_certify({kGood[0], bad}), "sphere 1");
  }
  for (const double bad : {-1.0, kNan, kInfinity, 2.0}) {
    EXPECT_EQ(of_certify(kGood, {.resolution = bad}), "resolution");
    EXPECT_EQ(of_certify(kGood, {.protrusion_tolerance = bad}), "protrusion tolerance");
    if (bad == 2.0) continue;
    EXPECT_EQ(of_certify(kGood, {.padding = bad}), "padding");
  }
  EXPECT_EQ(of_certify(kGood, {.resolution = 0.0}), "resolution");
  EXPECT_THROW(leak_points(kCube, Spheres{{Vector3d::Zero(), -1.0}}), Error);
  for (const double share : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THROW(leak_points(kCube, kGood, {.spacing = share}), Error);
    EXPECT_THROW(leak_points(kCube, kGood, {.separation = share}), Error);
    EXPECT_THROW(leak_surface(kCube, kGood, {.spacing = share}), Error);
  }
}

// Without an end if they were not.
TEST(Refusals, OfExternalSpheresThatNobodyPlaced) {
  const Spheres unusable{{kGood[0].center, kNan}};
  const ExternalSpheres box = box_of(kCube);
  const std::vector<double> levels{0.5};
  std::vector<ExternalSpheres> all(8, box);
  all[0] = {};
  all[1].box.min().x() = kNan;
  all[2].box.max().y() = kInfinity;
  all[3].box.max().z() = -1.0;
  all[4].padding = kNan;
  all[5].padding = -1.0;
  all[6].spheres.push_back({{0, kNan, 0}, 1.0});
  all[7].spheres.push_back({{9, 9, 9}, -1.0});
  for (const ExternalSpheres& bad : all) {
    EXPECT_EQ(of_certify(kGood, {.external = &bad}), "external spheres");
    EXPECT_EQ(refused([&] { cover(kCube, bad, {.max_error = 0.2}); }), "external spheres");
    EXPECT_EQ(refused([&] { repair(kCube, bad, kGood, {.max_error = 0.2}); }), "external spheres");
    EXPECT_EQ(refused([&] { fit_levels(kCube, bad, kGood, levels, {}); }), "external spheres");
    EXPECT_EQ(refused([&] { cover_breakdown(kCube, bad, kGood, 0.2); }), "external spheres");
    EXPECT_EQ(refused([&] { spheres_in_thin_parts(bad, kGood, 0.2); }), "external spheres");
  }
  EXPECT_EQ(refused([&] { cover_breakdown(kCube, box, unusable, 0.2); }), "sphere 0");
  EXPECT_EQ(refused([&] { spheres_in_thin_parts(box, unusable, 0.2); }), "sphere 0");
}

// Whatever a fit or an audit consists of is refused where it is called by itself, too.
TEST(Refusals, OfOtherRoundingModes) {
  const ExternalSpheres external = place_external_spheres(kCube, {.min_external_diameter = 4.0});
  const Spheres few = cover(kCube, external, {.max_error = 1.0, .effort = 0}).spheres;
  expect_rounding_to_nearest_is_needed(
      [&] { place_external_spheres(kCube, {.min_external_diameter = 4.0}); }, "stage 1");
  expect_rounding_to_nearest_is_needed(
      [&] { cover(kCube, external, {.max_error = 1.0, .effort = 0}); }, "cover");
  expect_rounding_to_nearest_is_needed(
      [&] { repair(kCube, external, few, {.max_error = 1.0, .effort = 0}); }, "repair");
  expect_rounding_to_nearest_is_needed([&] { certify(kCube, few, {.external = &external}); },
                                       "certify");
}

}  // namespace
}  // namespace spherule::test
