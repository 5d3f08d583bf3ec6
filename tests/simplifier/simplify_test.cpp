// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "simplifier/internal/stages.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace spherule::test::simplify_test {
namespace {

using Eigen::Vector3d;
using Record = std::map<std::string, OptionValue>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TriangleMesh triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

SimplifyOptions coarse(double max_error) {
  SimplifyOptions options;
  options.max_error = max_error;
  options.effort = 1;
  return options;
}

TEST(Simplify, ChoosesErrorAndDiameterFromTheSizeOfTheModel) {
  // A sheet: one per cent of its diagonal is coarse enough to be quick.
  const TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 0.05, 0.05});
  const Simplification result = simplify(mesh, {.effort = 1});
  const double diagonal = diagonal_of(mesh);
  EXPECT_DOUBLE_EQ(result.options.max_error, 0.01 * diagonal);
  EXPECT_DOUBLE_EQ(result.options.min_external_diameter, 0.04 * diagonal);
  EXPECT_EQ(result.external.min_external_diameter, result.options.min_external_diameter);
  EXPECT_TRUE(result.certificate.covered);
  EXPECT_EQ(result.certificate.sphere_count, result.cover.spheres.size());
  EXPECT_LE(*result.certificate.protrusion_over_simplified_max, result.options.max_error);
  EXPECT_GE(*result.certificate.volume_ratio, 1.0);
}

// The limit of the grid's cells in the place of a part that is as large as the usual one needs.
TEST(Simplify, SaysSoWhereADiameterThatItChoosesIsMoreThanFourErrors) {
  constexpr double kError = 0.008;
  const TriangleMesh bar = box_mesh({0, 0, 0}, {1, 0.03, 0.03});
  const SimplifyOptions options{.max_error = kError, .effort = 0};
  const SimplifiedSolid usual = simplified_solid(bar, options);
  EXPECT_FALSE(usual.larger_diameter);
  EXPECT_EQ(usual.options.min_external_diameter, 4.0 * kError);
  // A quarter of the limit is for the grid of a D that is chosen.
  const std::size_t limit = usual.external.nodes_examined;
  const Simplification larger = internal::simplify(bar, options, limit);
  EXPECT_TRUE(larger.larger_diameter);
  EXPECT_GT(larger.options.min_external_diameter, 4.0 * kError);
  EXPECT_EQ(larger.external.min_external_diameter, larger.options.min_external_diameter);
  EXPECT_TRUE(larger.certificate.covered);
  EXPECT_LE(*larger.certificate.protrusion_over_simplified_max, kError);
  // The stage alone chooses the same. One that is requested is not larger.
  const SimplifiedSolid solid = simplified_solid(bar, options, limit);
  EXPECT_TRUE(solid.larger_diameter);
  EXPECT_EQ(solid.external.spheres, larger.external.spheres);
  EXPECT_EQ(solid.options.min_external_diameter, larger.options.min_external_diameter);
  SimplifyOptions again = options;
  again.min_external_diameter = larger.options.min_external_diameter;
  const SimplifiedSolid requested = simplified_solid(bar, again);
  EXPECT_FALSE(requested.larger_diameter);
  EXPECT_EQ(requested.options.min_external_diameter, again.min_external_diameter);
}

TEST(Simplify, KeepsWhatIsGiven) {
  SimplifyOptions options = coarse(0.1);
  options.min_external_diameter = 0.7;
  options.padding = 0.01;
  options.min_radius = 0.15;
  options.external = ExternalPlacement::kRandom;
  options.external_limit = 500;
  options.seed = 5;
  options.method = CoverMethod::kPaper;
  const Simplification result = simplify(cube_mesh(), options);
  EXPECT_EQ(result.options.max_error, 0.1);
  EXPECT_EQ(result.external.min_external_diameter, 0.7);
  EXPECT_GE(result.external.padding, 0.01);
  EXPECT_EQ(result.external.nodes_examined, 500U);
  EXPECT_FALSE(result.cover.spheres_before_inflation.empty());
  for (const Sphere& s : result.cover.spheres) EXPECT_GE(s.radius, 0.15);
  EXPECT_TRUE(result.certificate.covered);
}

// Every stage, the first included.
TEST(Simplify, KeepsToTheThreadsItIsGiven) {
  SimplifyOptions options = coarse(0.2);
  options.threads = 1;
  std::set<std::string> stages;
  options.progress = [&](double, const char* what) {
    stages.insert(what);
    using tbb::global_control;
    EXPECT_EQ(global_control::active_value(global_control::max_allowed_parallelism), 1U) << what;
  };
  simplify(cube_mesh(), options);
  EXPECT_TRUE(stages.contains("flooding"));
  EXPECT_TRUE(stages.contains("covering: proving the first answer"));
  EXPECT_TRUE(stages.contains("proving the solid"));
}

TEST(Simplify, OptionsSurviveTheRecord) {
  SimplifyOptions options;
  options.max_error = 0.1;
  options.min_external_diameter = 3.0;
  options.padding = 1e-300;
  options.min_radius = 0.25;
  options.min_internal_diameter = 0.125;
  options.method = CoverMethod::kPaper;
  options.external = ExternalPlacement::kRandom;
  options.external_limit = 77;
  options.seed = 0x7fffffffffffffff;
  options.effort = 5;
  options.seconds = 2.5;
  const Record record = option_record(options, 1000.0);
  EXPECT_EQ(std::get<double>(record.at("scale")), 1000.0);
  const SimplifyOptions back = options_from_record(record);
  EXPECT_EQ(option_record(back, 1000.0), record);
  EXPECT_EQ(back.max_error, options.max_error);
  EXPECT_EQ(back.min_external_diameter, options.min_external_diameter);
  EXPECT_EQ(back.padding, options.padding);
  EXPECT_EQ(back.min_radius, options.min_radius);
  EXPECT_EQ(back.min_internal_diameter, options.min_internal_diameter);
  EXPECT_EQ(back.method, options.method);
  EXPECT_EQ(back.external, options.external);
  EXPECT_EQ(back.external_limit, options.external_limit);
  EXPECT_EQ(back.seed, options.seed);
  EXPECT_EQ(back.effort, options.effort);
  EXPECT_EQ(back.seconds, options.seconds);
  for (const ExternalPlacement placement :
       {ExternalPlacement::kReachable, ExternalPlacement::kNone}) {
    options.external = placement;
    EXPECT_EQ(options_from_record(option_record(options, 1.0)).external, placement);
  }
}

TEST(Simplify, WhatARecordLacksKeepsItsDefault) {
  // But for what was made before the flood was made tighter than its grid.
  SimplifyOptions defaults;
  defaults.tightness = ExternalOptions::kNoTightness;
  EXPECT_EQ(option_record(options_from_record({}), 1.0), option_record(defaults, 1.0));
  // Whole numbers are numbers.
  EXPECT_EQ(options_from_record({{"max-error", std::int64_t{2}}}).max_error, 2.0);
}

TEST(Simplify, BadRecordsAreRefusedByName) {
  const auto refused = [](const std::string& key, const OptionValue& value) -> std::string {
    try {
      options_from_record({{key, value}});
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  for (const char* key :
       {"max-error", "min-external", "padding", "min-radius", "min-internal", "seconds"}) {
    EXPECT_EQ(refused(key, std::string("wide")), key);
    EXPECT_EQ(refused(key, true), key);
    for (const double bad : {-1.0, kNan, kInfinity, 1e300}) EXPECT_EQ(refused(key, bad), key);
  }
  EXPECT_EQ(refused("effort", std::int64_t{1} << 40), "effort");
  for (const char* key : {"seed", "external-limit", "effort"}) {
    EXPECT_EQ(refused(key, std::int64_t{-1}), key);
    EXPECT_EQ(refused(key, 1.5), key);
  }
  for (const char* key : {"method", "external"}) {
    EXPECT_EQ(refused(key, std::string()), key);
    EXPECT_EQ(refused(key, std::int64_t{1}), key);
  }
  EXPECT_EQ(refused("external", std::string("other")), "external");
}

// --- a stage 2 method from outside ---

TEST(Stage2Method, ItsSpheresAreCertifiedWhateverItMade) {
  const auto made_of = [](std::vector<Sphere> spheres) {
    SimplifyOptions options = coarse(0.3);
    options.stage2_method = Stage2Method{
        "given", [=](const TriangleMesh&, const ExternalSpheres&, const CoverOptions& passed) {
          EXPECT_EQ(passed.max_error, 0.3);
          EXPECT_EQ(passed.threads, 1);
          SphereCover made;
          made.spheres = spheres;
          return made;
        }};
    options.threads = 1;
    return simplify(cube_mesh(), options);
  };
  const Vector3d middle(0.5, 0.5, 0.5);
  const Simplification covered = made_of({{middle, 0.87}});
  EXPECT_TRUE(covered.certificate.covered);
  EXPECT_NE(broken_promises(covered).find("to protrude by at most 0.3"), std::string::npos);
  EXPECT_EQ(broken_promises(covered).find("to cover"), std::string::npos);
  const Simplification leaking = made_of({{middle, 0.79}});
  EXPECT_FALSE(leaking.certificate.covered);
  EXPECT_NE(broken_promises(leaking).find("to cover"), std::string::npos);
  EXPECT_EQ(broken_promises(leaking).find("to protrude"), std::string::npos);
  EXPECT_FALSE(made_of({}).certificate.covered);
}

TEST(Stage2Method, ItsNameSurvivesTheRecordButCannotBeRunFromThere) {
  SimplifyOptions options = coarse(0.3);
  options.stage2_method = Stage2Method{"other", cover};
  const Record record = option_record(options, 1.0);
  EXPECT_EQ(std::get<std::string>(record.at("method")), "other");
  const SimplifyOptions back = options_from_record(record);
  ASSERT_TRUE(back.stage2_method.has_value());
  EXPECT_EQ(back.stage2_method->name, "other");
  EXPECT_EQ(option_record(back, 1.0), record);
  EXPECT_FALSE(options_from_record(option_record({}, 1.0)).stage2_method.has_value());
  const auto refused = [](const SimplifyOptions& tried) -> std::string {
    try {
      simplify(cube_mesh(), tried);
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  EXPECT_EQ(refused(back), "method");
  EXPECT_EQ(refused(options), "accepted");
  for (const char* name : {"", "cover", "paper"}) {
    options.stage2_method->name = name;
    EXPECT_EQ(refused(options), "method");
  }
}

TEST(Simplify, MethodsAndPlacementsHaveNames) {
  EXPECT_EQ(method_named(method_names().front()), SimplifyOptions{}.method);
  EXPECT_EQ(placement_named(placement_names().front()), SimplifyOptions{}.external);
  for (const std::string& name : method_names()) {
    const Record record = option_record({.method = method_named(name)}, 1.0);
    EXPECT_EQ(std::get<std::string>(record.at("method")), name);
  }
  for (const std::string& name : placement_names()) {
    const Record record = option_record({.external = placement_named(name)}, 1.0);
    EXPECT_EQ(std::get<std::string>(record.at("external")), name);
  }
  EXPECT_THROW(method_named("other"), Error);
  EXPECT_THROW(placement_named(""), Error);
}

TEST(Simplify, BadOptionsAreRefusedByName) {
  const auto refused = [](SimplifyOptions options,
                          const TriangleMesh& mesh = cube_mesh()) -> std::string {
    if (options.max_error == 0.0) options.max_error = 0.2;
    try {
      simplify(mesh, options);
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  for (const double bad : {-1.0, kNan, kInfinity}) {
    EXPECT_EQ(refused(coarse(bad)), "max error") << bad;
    EXPECT_EQ(refused({.min_external_diameter = bad}), "min external diameter") << bad;
    EXPECT_EQ(refused({.padding = bad}), "padding") << bad;
    EXPECT_EQ(refused({.min_radius = bad}), "min radius") << bad;
    EXPECT_EQ(refused({.min_internal_diameter = bad}), "min internal diameter") << bad;
  }
  EXPECT_EQ(refused({}, {}), "mesh");
  TriangleMesh broken = cube_mesh();
  broken.triangles[0][1] = 8;
  EXPECT_EQ(refused({}, broken), "mesh");
}

// Input with no volume, no area or no extent at all.
TEST(Simplify, DegenerateInputIsCovered) {
  const std::vector<NamedMesh> meshes = {
      {"line", triangle({0, 0, 0}, {1, 2, 3}, {0.5, 1, 1.5})},
      {"line along an axis", triangle({0, 0, 0}, {1, 0, 0}, {0.25, 0, 0})},
      {"triangle", triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
      {"point", triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3})},
      {"two points", joined(triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
                            triangle({1, 0, 0}, {1, 0, 0}, {1, 0, 0}))}};
  Random random(101);
  for (const NamedMesh& named : meshes) {
    for (const CoverMethod method :
         effort(std::vector{CoverMethod::kCover, CoverMethod::kPaper}, 1)) {
      SCOPED_TRACE(named.name);
      SimplifyOptions options = coarse(0.1);
      options.method = method;
      const Simplification result = simplify(named.mesh, options);
      EXPECT_TRUE(result.certificate.covered);
      EXPECT_FALSE(result.cover.spheres.empty());
      EXPECT_LE(*result.certificate.protrusion_over_simplified_max, 0.1);
      const auto points = points_on_surface(named.mesh, 300, random);
      EXPECT_EQ(judge_cover(points, result.cover.spheres).uncovered, 0U);
    }
  }
}

// The default error is a share of the diagonal, and a point has none.
TEST(Simplify, APointNeedsAnErrorOfItsOwn) {
  EXPECT_THROW(simplify(triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3})), Error);
}

TEST(Simplify, AFileHoldsSpheresCertificateAndOptions) {
  const Simplification result = simplify(l_bracket(), coarse(0.1));
  const SphereFile file = sphere_file(result, 2.0);
  EXPECT_EQ(file.spheres, result.cover.spheres);
  EXPECT_EQ(file.options, option_record(result.options, 2.0));
  ASSERT_TRUE(file.certificate.has_value());
  EXPECT_TRUE(file.certificate->covered);
  EXPECT_EQ(file.certificate->sphere_count, file.spheres.size());
  EXPECT_EQ(file.certificate->protrusion_over_simplified_max,
            result.certificate.protrusion_over_simplified_max);
  EXPECT_EQ(file.certificate->protrusion_over_mesh_max,
            result.certificate.protrusion_over_mesh->upper);

  // An audit from the file alone comes to the same end.
  const SimplifyOptions options = options_from_record(file.options);
  const ExternalSpheres external =
      place_external_spheres(l_bracket(), {.placement = options.external,
                                           .min_external_diameter = options.min_external_diameter,
                                           .padding = options.padding,
                                           .max_error = options.max_error,
                                           .limit = options.external_limit,
                                           .seed = options.seed});
  EXPECT_EQ(external.spheres, result.external.spheres);
}

}  // namespace
}  // namespace spherule::test::simplify_test
