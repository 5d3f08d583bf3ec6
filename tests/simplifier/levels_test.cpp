// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <limits>

namespace spherule::test {
namespace {

// The finest error as a share of the size, with D the same multiple of it.
constexpr double kFinest = kSanitized ? 0.09 : 0.075;

Simplification fitted_levels(const TriangleMesh& mesh, CoverMethod method = CoverMethod::kCover,
                             double min_radius = 0.0, int threads = 0) {
  const double size = diagonal_of(mesh);
  return simplify(mesh, {.levels = {2.0 * kFinest * size, kFinest * size, 4.0 * kFinest * size},
                         .min_external_diameter = 4.0 * kFinest * size,
                         .min_radius = min_radius * size,
                         .method = method,
                         .effort = effort(3, 1),
                         .threads = threads});
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
  for (const CoverLevel& level : result.levels) {
    SCOPED_TRACE(level.max_error);
    expect_enclosed(finer, level.spheres);
    EXPECT_LE(level.spheres.spheres.size(), finer.size());
    const OctreeProof proof = prove_by_octree(result.external, level.spheres.spheres, 26,
                                              static_cast<std::size_t>(effort(300'000, 60'000)));
    EXPECT_NE(proof.verdict, OctreeVerdict::kLeak) << proof.point.transpose();
    if (result.options.min_radius == 0.0) {
      EXPECT_LE(level.protrusion, level.max_error);
      EXPECT_EQ(judge_protrusion(level.spheres.spheres, mesh, result.external,
                                 level.protrusion + 1e-9 * size,
                                 static_cast<std::size_t>(effort(12, 3)), random)
                    .beyond,
                0U);
    }
    EXPECT_LE(level.clustering_count, level.spheres.spheres.size());
    finer = level.spheres.spheres;
  }
  const LevelTree tree = level_tree(result.cover.spheres, result.levels);
  for (std::size_t k = 0; k < result.levels.size(); ++k) {
    ASSERT_EQ(tree.nodes[k].size(), result.levels[k].spheres.spheres.size());
  }
}

TEST(Levels, EncloseTheFinerOnesAndProtrudeByNoMoreThanTheirError) {
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    expect_good_levels(named.mesh, fitted_levels(named.mesh));
    if (HasFailure()) return;
  }
}

TEST(Levels, StandAboveThePapersSpheresAndAboveALeastRadius) {
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

TEST(Levels, AreEqualInEveryRunOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const Simplification first = fitted_levels(l_bracket());
  for (const int threads : {1, 2}) {
    const Simplification again = fitted_levels(l_bracket(), CoverMethod::kCover, 0.0, threads);
    for (std::size_t k = 0; k < first.levels.size(); ++k) {
      EXPECT_EQ(first.levels[k].spheres.spheres, again.levels[k].spheres.spheres);
      EXPECT_EQ(first.levels[k].spheres.parent_of, again.levels[k].spheres.parent_of);
      EXPECT_EQ(first.levels[k].protrusion, again.levels[k].protrusion);
    }
  }
}

TEST(Levels, TheFinestIsTheErrorOfTheCover) {
  const TriangleMesh mesh = cube_mesh();
  constexpr double kFine = kSanitized ? 0.35 : 0.1;
  constexpr double kCoarse = 2.0 * kFine;
  const auto levels = [&](double max_error, std::vector<double> queried) {
    return simplify(mesh, {.max_error = max_error, .levels = std::move(queried), .effort = 0});
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

TEST(Levels, RefusesErrorsOutOfRange) {
  const auto reason = [](double max_error, const std::vector<double>& levels) -> std::string {
    try {
      simplify(cube_mesh(), {.max_error = max_error, .levels = levels, .effort = 0});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -0.1, nan, 1e300}) {
    EXPECT_NE(reason(0.0, {0.1, bad}).find("levels: must be positive"), std::string::npos) << bad;
  }
  EXPECT_NE(reason(0.1, {0.2, 0.05}).find("finer than the max error"), std::string::npos);
  EXPECT_NE(reason(0.1, {0.2, 0.2001}).find("1 % larger"), std::string::npos);
}

TEST(Levels, AreStoredAsText) {
  const std::vector<double> levels = {80.0, 0.1, 1e-7};
  EXPECT_EQ(name_of_levels(levels), "80,0.1,1e-07");
  EXPECT_EQ(levels_named("80,0.1,1e-07"), levels);
  for (const char* bad : {"", "1,", ",1", "1,,2", "1 ,2", "a", "1;2", "nan", "inf"}) {
    EXPECT_THROW(levels_named(bad), Error) << bad;
  }
  SimplifyOptions options;
  EXPECT_FALSE(option_record(options, 1.0).contains("levels"));
  options.levels = levels;
  EXPECT_EQ(options_from_record(option_record(options, 1.0)).levels, levels);
}

}  // namespace
}  // namespace spherule::test
