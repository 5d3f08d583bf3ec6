// SPDX-License-Identifier: BSD-3-Clause
// Both stages and their proofs in one call: its options and their record, levels above a cover,
// several bodies, and what it refuses.
#include "simplifier/simplify.h"

#include "simplifier/bodies.h"
#include "simplifier/internal/stages.h"
#include "simplifier/option_record.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Record = std::map<std::string, OptionValue>;
using Spheres = std::vector<Sphere>;

SimplifyOptions coarse(double max_error) {
  return {.max_error = max_error, .effort = 1};
}

bool says(const Simplification& result, const std::string& what) {
  return broken_promises(result).find(what) != std::string::npos;
}

TEST(Simplify, ChoosesErrorAndDiameterFromTheSizeOfTheModel) {
  // A bar: one per cent of its diagonal is coarse enough to be quick.
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
  const Simplification result = simplify(cube_mesh(), {.max_error = 0.1,
                                                       .min_external_diameter = 0.7,
                                                       .padding = 0.01,
                                                       .min_radius = 0.15,
                                                       .method = CoverMethod::kPaper,
                                                       .external = ExternalPlacement::kRandom,
                                                       .external_limit = 500,
                                                       .seed = 5});
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
  for (const char* what : {"flooding", "covering: proving the first answer", "proving the solid"}) {
    EXPECT_TRUE(stages.contains(what)) << what;
  }
}

// Input with no volume, no area or no extent at all, and sheets so thin that the solid is as thick
// as the external spheres leave it.
TEST(Simplify, DegenerateInputIsCovered) {
  const auto triangle = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return TriangleMesh{{a, b, c}, {{0, 1, 2}}};
  };
  const auto point = [&](const Vector3d& at) { return triangle(at, at, at); };
  const std::vector<NamedMesh> meshes = {
      {"line", triangle({0, 0, 0}, {1, 2, 3}, {0.5, 1, 1.5})},
      {"line along an axis", triangle({0, 0, 0}, {1, 0, 0}, {0.25, 0, 0})},
      {"triangle", triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
      {"point", point({1, 2, 3})},
      {"two points", joined(point({0, 0, 0}), point({1, 0, 0}))},
      {"thin sheet", thin_sheet(1e-3)},
      {"thinner sheet", thin_sheet(1e-9)},
      {"flat sheet", thin_sheet(0.0)}};
  Random random(101);
  for (const NamedMesh& named : meshes) {
    for (const CoverMethod method :
         effort(std::vector{CoverMethod::kPaper, CoverMethod::kCover}, 1)) {
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
  // The default error is a share of the diagonal, and a point has none.
  EXPECT_THROW(simplify(point({1, 2, 3})), Error);
}

// --- promises that a fit did not keep ---

TEST(BrokenPromises, AreNamed) {
  const std::string leak = "not proved to cover";
  const std::string protrudes = "protrude";
  struct Case {
    bool covered;
    std::optional<double> protrusion;  // of E = 2
    double min_radius;
    std::vector<std::string> said;
  };
  for (const auto& [covered, protrusion, min_radius, said] : std::vector<Case>{
           {true, 2.0, 0.0, {}},
           {true, 1.5, 0.5, {}},
           {false, 2.0, 0.0, {leak}},
           {false, 2.5, 0.0, {leak, protrudes}},
           {true, 2.0 + 1e-15, 0.0, {"at most 2 from the simplified solid", protrudes}},
           {true, 3.5, 0.0, {"only by at most 3.5", protrudes}},
           {true, std::nullopt, 0.0, {protrudes}},
           // Forced by a least radius.
           {true, 3.5, 0.5, {}},
           {false, 3.5, 0.5, {leak}}}) {
    Simplification result;
    result.options = {.max_error = 2.0, .min_radius = min_radius};
    result.certificate.covered = covered;
    result.certificate.protrusion_over_simplified_max = protrusion;
    SCOPED_TRACE(broken_promises(result));
    EXPECT_EQ(broken_promises(result).empty(), said.empty());
    for (const std::string& what : said) EXPECT_TRUE(says(result, what)) << what;
    for (const std::string& what : {leak, protrudes}) {
      EXPECT_EQ(says(result, what), std::ranges::count(said, what) > 0) << what;
    }
  }
  // A level that protrudes further than its own error.
  Simplification result;
  result.options.max_error = 2.0;
  result.certificate.covered = true;
  result.certificate.protrusion_over_simplified_max = 2.0;
  result.levels.resize(2);
  result.levels[0].max_error = result.levels[0].protrusion = 4.0;
  result.levels[1].max_error = 8.0;
  result.levels[1].protrusion = 7.5;
  EXPECT_EQ(broken_promises(result), "");
  result.levels[1].protrusion = 8.5;
  EXPECT_TRUE(says(result, "at most 8 in a level, only by at most 8.5"));
}

// --- the record of options ---

TEST(SimplifyRecord, HoldsAllOptions) {
  SimplifyOptions options{.max_error = 0.1,
                          .levels = {80.0, 0.1, 1e-7},
                          .min_external_diameter = 3.0,
                          .padding = 1e-300,
                          .min_radius = 0.25,
                          .method = CoverMethod::kPaper,
                          .external = ExternalPlacement::kRandom};
  options.min_internal_diameter = 0.125;
  options.external_limit = 77;
  options.seed = 0x7fffffffffffffff;
  options.effort = 5;
  options.seconds = 2.5;
  const Record record = option_record(options, 1000.0);
  EXPECT_EQ(std::get<double>(record.at("scale")), 1000.0);
  const SimplifyOptions back = options_from_record(record);
  EXPECT_EQ(option_record(back, 1000.0), record);
  const auto fields = [](const SimplifyOptions& o) {
    return std::tie(o.max_error, o.levels, o.min_external_diameter, o.padding, o.min_radius,
                    o.min_internal_diameter, o.method, o.external, o.external_limit, o.seed,
                    o.effort, o.seconds);
  };
  EXPECT_TRUE(fields(back) == fields(options));
}

TEST(SimplifyRecord, WhatItLacksKeepsItsDefault) {
  // But for what was made before the flood was made tighter than its grid.
  SimplifyOptions defaults;
  defaults.tightness = ExternalOptions::kNoTightness;
  EXPECT_EQ(option_record(options_from_record({}), 1.0), option_record(defaults, 1.0));
  EXPECT_FALSE(option_record(defaults, 1.0).contains("levels"));
  // Whole numbers are numbers.
  EXPECT_EQ(options_from_record({{"max-error", std::int64_t{2}}}).max_error, 2.0);
}

TEST(SimplifyRecord, NamesMethodsAndPlacements) {
  EXPECT_EQ(method_named(method_names().front()), SimplifyOptions{}.method);
  EXPECT_EQ(placement_named(placement_names().front()), SimplifyOptions{}.external);
  for (const std::string& name : method_names()) {
    const Record record = option_record({.method = method_named(name)}, 1.0);
    EXPECT_EQ(std::get<std::string>(record.at("method")), name);
  }
  for (const std::string& name : placement_names()) {
    const Record record = option_record({.external = placement_named(name)}, 1.0);
    EXPECT_EQ(std::get<std::string>(record.at("external")), name);
    EXPECT_EQ(options_from_record(record).external, placement_named(name));
  }
  EXPECT_THROW(method_named("other"), Error);
  EXPECT_THROW(placement_named(""), Error);
  EXPECT_EQ(name_of_levels(std::vector{80.0, 0.1, 1e-7}), "80,0.1,1e-07");
  for (const char* bad : {"", "1,", ",1", "1,,2", "1 ,2", "a", "1;2", "nan", "inf"}) {
    EXPECT_THROW(levels_named(bad), Error) << bad;
  }
}

TEST(SimplifyRecord, BadValuesAreRefusedByName) {
  const std::vector<OptionValue> no_lengths = {std::string("wide"), true, -1.0, kNan,
                                               kInfinity,           1e300};
  const std::vector<OptionValue> no_counts = {std::int64_t{-1}, 1.5};
  const std::vector<OptionValue> no_names = {std::string(), std::int64_t{1}};
  const std::vector<std::pair<std::string, std::vector<OptionValue>>> cases = {
      {"max-error", no_lengths},
      {"min-external", no_lengths},
      {"padding", no_lengths},
      {"min-radius", no_lengths},
      {"min-internal", no_lengths},
      {"seconds", no_lengths},
      {"seed", no_counts},
      {"external-limit", no_counts},
      {"effort", no_counts},
      {"method", no_names},
      {"external", no_names},
      {"effort", {std::int64_t{1} << 40}},
      {"external", {std::string("other")}}};
  for (const auto& [key, values] : cases) {
    for (const OptionValue& value : values) {
      EXPECT_EQ(refused([&, &key = key] { options_from_record({{key, value}}); }), key);
    }
  }
}

// --- a stage 2 method from outside ---

TEST(Stage2Method, ItsSpheresAreCertifiedWhateverItMade) {
  const auto made_of = [](const Spheres& spheres) {
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
  EXPECT_TRUE(says(covered, "to protrude by at most 0.3"));
  EXPECT_FALSE(says(covered, "to cover"));
  const Simplification leaking = made_of({{middle, 0.79}});
  EXPECT_FALSE(leaking.certificate.covered);
  EXPECT_TRUE(says(leaking, "to cover"));
  EXPECT_FALSE(says(leaking, "to protrude"));
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
  EXPECT_EQ(refused([&] { simplify(cube_mesh(), back); }), "method");
  EXPECT_EQ(refused([&] { simplify(cube_mesh(), options); }), "accepted");
  for (const char* name : {"", "cover", "paper"}) {
    options.stage2_method->name = name;
    EXPECT_EQ(refused([&] { simplify(cube_mesh(), options); }), "method");
  }
}

// --- levels above a cover ---

// The finest error as a share of the size, with D the same multiple of it.
constexpr double kFinest = kSanitized ? 0.09 : 0.075;

Simplification fitted_levels(const TriangleMesh& mesh, CoverMethod method = CoverMethod::kCover,
                             double min_radius = 0.0) {
  const double size = diagonal_of(mesh);
  return simplify(mesh, {.levels = {2.0 * kFinest * size, kFinest * size, 4.0 * kFinest * size},
                         .min_external_diameter = 4.0 * kFinest * size,
                         .min_radius = min_radius * size,
                         .method = method,
                         .effort = effort(3, 1)});
}

// Every child lies in its parent, in long double: more bits than the reserve of the parents.
void expect_enclosed(std::span<const Sphere> finer, const SphereLevel& level) {
  ASSERT_EQ(level.parent_of.size(), finer.size());
  for (std::size_t i = 0; i < finer.size(); ++i) {
    const Sphere& parent = level.spheres.at(static_cast<std::size_t>(level.parent_of[i]));
    EXPECT_LE(judged_distance(parent.center, finer[i].center) + Real{finer[i].radius},
              Real{parent.radius});
  }
}

void expect_good_levels(const TriangleMesh& mesh, const Simplification& result) {
  const double size = diagonal_of(mesh);
  Random random(81);
  ASSERT_EQ(result.levels.size(), 2U);
  EXPECT_EQ(result.options.max_error, kFinest * size);
  std::span<const Sphere> finer = result.cover.spheres;
  const LevelTree tree = level_tree(result.cover.spheres, result.levels);
  for (std::size_t k = 0; k < result.levels.size(); ++k) {
    const CoverLevel& level = result.levels[k];
    const Spheres& spheres = level.spheres.spheres;
    SCOPED_TRACE(level.max_error);
    expect_enclosed(finer, level.spheres);
    EXPECT_LE(spheres.size(), finer.size());
    EXPECT_EQ(tree.nodes[k].size(), spheres.size());
    EXPECT_LE(level.clustering_count, spheres.size());
    const OctreeProof proof =
        prove_by_octree(result.external, spheres, 26, samples(300'000, 60'000));
    EXPECT_NE(proof.verdict, OctreeVerdict::kLeak) << proof.point.transpose();
    if (result.options.min_radius == 0.0) {
      EXPECT_LE(level.protrusion, level.max_error);
      const double most = level.protrusion + 1e-9 * size;
      EXPECT_EQ(
          judge_protrusion(spheres, mesh, result.external, most, samples(12, 3), random).beyond,
          0U);
    }
    finer = spheres;
  }
}

TEST(Levels, EncloseTheFinerOnesAndProtrudeByNoMoreThanTheirError) {
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    expect_good_levels(named.mesh, fitted_levels(named.mesh));
    if (HasFailure()) return;
  }
  // Above the paper's spheres, and above a least radius.
  expect_good_levels(l_bracket(), fitted_levels(l_bracket(), CoverMethod::kPaper));
  expect_good_levels(l_bracket(), fitted_levels(l_bracket(), CoverMethod::kCover, 0.1));
}

// With an error so small that no level is a single sphere: a sphere around a cube is as good as
// another.
TEST(Levels, AreFewerAndCloserThanPlainClustering) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = cube_mesh();
  const double finest = 0.06 * diagonal_of(mesh);
  const Simplification result = simplify(mesh, {.levels = {finest, 2.0 * finest, 4.0 * finest},
                                                .min_external_diameter = 4.0 * finest,
                                                .effort = 1});
  std::size_t finer = result.cover.spheres.size();
  for (const CoverLevel& level : result.levels) {
    EXPECT_LT(level.spheres.spheres.size(), finer);
    EXPECT_LT(level.protrusion, level.clustering_protrusion);
    finer = level.spheres.spheres.size();
  }
}

TEST(Levels, TheFinestIsTheErrorOfTheCover) {
  constexpr double kFine = kSanitized ? 0.35 : 0.1;
  constexpr double kCoarse = 2.0 * kFine;
  const auto levels = [&](double max_error, std::vector<double> queried) {
    return simplify(cube_mesh(),
                    {.max_error = max_error, .levels = std::move(queried), .effort = 0});
  };
  for (const auto& result :
       {levels(kFine, {kCoarse}), levels(0.0, {kFine, kCoarse}), levels(kFine, {kCoarse, kFine})}) {
    EXPECT_EQ(result.options.max_error, kFine);
    EXPECT_EQ(result.options.levels, (std::vector{kCoarse, kFine}));
    ASSERT_EQ(result.levels.size(), 1U);
    EXPECT_EQ(result.levels[0].max_error, kCoarse);
  }
  EXPECT_TRUE(levels(kFine, {}).levels.empty());
  EXPECT_TRUE(levels(0.0, {kFine}).levels.empty());
}

// --- several bodies ---

const Pose kTurned(Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized())),
                   {10, -20, 1.0 / 3.0});

std::vector<Body> bracket_and_copy() {
  return {{.name = "bracket", .mesh = l_bracket()},
          {.name = "copy", .mesh = {}, .copy = BodyCopy{0, kTurned}},
          {.name = "cube", .mesh = cube_mesh()}};
}

const SimplifyOptions kBodyOptions{.max_error = 0.15, .effort = 0};

SphereFile file_of(const std::vector<BodyFit>& fits) {
  return sphere_file(bracket_and_copy(), fits, std::vector<double>(3, 1.0));
}

// In extended precision, with the quaternion that the pose holds.
TEST(Bodies, MovedSpheresHoldTheExactlyMovedOnes) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  Spheres spheres;
  for (int i = 0; i < 200; ++i) {
    spheres.push_back({{1e3 * std::sin(i), 1e-3 * i, 7.0 / (i + 1)}, i == 0 ? 0.0 : 1.0 / i});
  }
  const Spheres moved = moved_spheres(spheres, kTurned);
  const Eigen::Quaternion<Real> q = kTurned.rotation().cast<Real>().normalized();
  ASSERT_EQ(moved.size(), spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector exact =
        q * Vector(spheres[i].center.cast<Real>()) + Vector(kTurned.translation().cast<Real>());
    const Real miss = (Vector(moved[i].center.cast<Real>()) - exact).norm();
    EXPECT_LE(miss + Real{spheres[i].radius}, moved[i].radius);
    EXPECT_LE(moved[i].radius - spheres[i].radius, 1e-10);
  }
}

// Against the mesh of the copy in its place, which the fit has not seen.
TEST(Bodies, ACopyIsCoveredAsItsOriginalIs) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const std::vector<BodyFit> fits = fit_bodies(bracket_and_copy(), kBodyOptions);
  ASSERT_EQ(fits.size(), 3u);
  for (const BodyFit& fit : fits) EXPECT_EQ(fit.broken, "");
  EXPECT_EQ(fits[0].spheres, simplify(l_bracket(), kBodyOptions).cover.spheres);
  const TriangleMesh placed = moved(l_bracket(), kTurned.isometry());
  EXPECT_TRUE(certify(placed, fits[1].spheres).covered);
  EXPECT_FALSE(certify(placed, fits[0].spheres).covered);
  EXPECT_TRUE(fits[1].certificate.covered);
  EXPECT_GT(*fits[1].certificate.protrusion_over_simplified_max,
            *fits[0].certificate.protrusion_over_simplified_max);
  const SphereFile file = file_of(fits);
  EXPECT_EQ(file.spheres.size(),
            fits[0].spheres.size() + fits[1].spheres.size() + fits[2].spheres.size());
  EXPECT_TRUE(file.certificate->covered);
  EXPECT_EQ(file.certificate->protrusion_over_simplified_max,
            std::max(fits[1].certificate.protrusion_over_simplified_max,
                     fits[2].certificate.protrusion_over_simplified_max));
}

TEST(Bodies, AStopKeepsWhatIsProvedAndNoMore) {
  const auto fits_with = [](std::stop_source& stop, SimplifyOptions options) {
    options.threads = 1;
    options.stop = stop.get_token();
    return fit_bodies(bracket_and_copy(), options);
  };
  const auto expect_marked = [](const SphereFile& file, bool interrupted) {
    EXPECT_EQ(file.interrupted, interrupted);
    for (const BodyRecord& body : file.bodies) EXPECT_EQ(body.interrupted, interrupted);
  };
  std::stop_source before;
  before.request_stop();
  const std::vector<BodyFit> none = fits_with(before, kBodyOptions);
  for (const BodyFit& fit : none) {
    EXPECT_TRUE(fit.spheres.empty());
    EXPECT_FALSE(fit.certificate.covered);
    EXPECT_NE(fit.broken, "");
    EXPECT_TRUE(fit.interrupted);
  }
  EXPECT_FALSE(file_of(none).certificate->covered);
  // The first answer queries the stop: on one thread that body is all there is.
  std::stop_source amid;
  SimplifyOptions options = kBodyOptions;
  options.on_proved = [&](std::size_t) { amid.request_stop(); };
  const std::vector<BodyFit> some = fits_with(amid, options);
  EXPECT_EQ(some[0].broken, "");
  EXPECT_EQ(some[1].broken, "");
  EXPECT_NE(some[2].broken, "");
  expect_marked(file_of(some), true);
  // After the search it marks nothing.
  std::stop_source after;
  const std::vector<BodyFit> all = fits_with(after, kBodyOptions);
  after.request_stop();
  expect_marked(file_of(all), false);
}

TEST(Bodies, WhatIsWrongNamesTheBody) {
  const auto error = [](const std::vector<Body>& bodies, const SimplifyOptions& options) {
    return refusal([&] { fit_bodies(bodies, options); });
  };
  std::vector<Body> bodies = bracket_and_copy();
  bodies[2].mesh.triangles.front()[0] = 99;
  EXPECT_TRUE(error(bodies, kBodyOptions).starts_with("cube: "));
  bodies = bracket_and_copy();
  bodies[1].copy->of = 2;
  EXPECT_TRUE(error(bodies, kBodyOptions).starts_with("copy: "));
  SimplifyOptions options = kBodyOptions;
  options.levels = {0.2, 0.4};
  EXPECT_TRUE(error(bracket_and_copy(), options).starts_with("levels: "));
}

}  // namespace
}  // namespace spherule::test
