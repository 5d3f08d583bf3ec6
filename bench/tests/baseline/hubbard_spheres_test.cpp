// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/made_conservative.h"
#include "bench/baseline/medial_cover.h"
#include "bench/baseline/mesh_probe.h"
#include "bench/tests/baseline/cover_check.h"
#include "spheretree/check.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace spherule::test {
namespace {

const HubbardOptions kCoarse = {.counts = {1, 6, 30}, .sites = 150, .cover_points = 400};

TEST(HubbardSpheres, EveryLevelHoldsTheSamples) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    const SphereLevels levels = hubbard_spheres(named.mesh, kCoarse);
    ASSERT_EQ(levels.levels.size(), 3U);
    ASSERT_EQ(levels.parents.size(), 2U);
    const auto samples = internal::cover_samples(named.mesh, kCoarse.cover_points, 1, kCoarse.seed);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(levels.levels[k].size(), kCoarse.counts[k]);
      EXPECT_EQ(judge_cover(samples, levels.levels[k]).uncovered, 0U);
    }
  }
}

TEST(HubbardSpheres, ReachesTheWantedCounts) {
  const SphereLevels levels = hubbard_spheres(l_bracket(), kCoarse);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(levels.levels[k].size(), kCoarse.counts[k]);
  // Each sphere is what became of some of the finer ones.
  for (std::size_t k = 0; k < 2; ++k) {
    const std::set<std::int32_t> parents(levels.parents[k].begin(), levels.parents[k].end());
    EXPECT_EQ(parents.size(), levels.levels[k].size());
  }
}

TEST(CoverSamples, HoldCornersAndEdges) {
  const TriangleMesh mesh = cube_mesh();
  const std::vector<Eigen::Vector3d> samples = internal::cover_samples(mesh, 200, 1, 1);
  const auto count = [&](int integers) {
    return std::ranges::count_if(samples, [&](const Eigen::Vector3d& p) {
      return (p.array() == p.array().round()).count() == integers;
    });
  };
  EXPECT_EQ(count(3), 8);
  // As far from each other as those spread over the area: the square root of 6 / 200.
  EXPECT_EQ(count(2), 12 * 4);
}

TEST(HubbardSpheres, MakesAConservativeTree) {
  const TriangleMesh mesh = slender(l_bracket());
  const SphereLevels levels = hubbard_spheres(mesh, kCoarse);
  const ConservativeSpheres leaves = made_conservative(mesh, levels.levels.back());
  EXPECT_TRUE(leaves.certificate.covered);
  const LevelTree tree = enclosing_tree(levels, leaves.spheres);
  EXPECT_TRUE(check(tree.tree).valid);
  // Each sphere of a level stands in the tree and is no smaller than it was.
  ASSERT_EQ(tree.nodes.size(), 2U);
}

TEST(HubbardSpheres, EnclosingTreeRefusesWhatDoesNotAgree) {
  SphereLevels levels = hubbard_spheres(l_bracket(), kCoarse);
  EXPECT_THROW(enclosing_tree(levels, levels.levels.front()), Error);
  EXPECT_THROW(enclosing_tree({}, {}), Error);
  SphereLevels bad = levels;
  bad.parents[1][0] = 6;
  EXPECT_THROW(enclosing_tree(bad, bad.levels.back()), Error);
  bad = levels;
  bad.parents[0].pop_back();
  EXPECT_THROW(enclosing_tree(bad, bad.levels.back()), Error);
}

TEST(HubbardSpheres, IsTheSameForEqualSeedOnAnyNumberOfThreads) {
  HubbardOptions options = kCoarse;
  options.threads = 1;
  const SphereLevels one = hubbard_spheres(l_bracket(), options);
  options.threads = 3;
  const SphereLevels three = hubbard_spheres(l_bracket(), options);
  EXPECT_EQ(one.levels, three.levels);
  EXPECT_EQ(one.parents, three.parents);
}

TEST(HubbardSpheres, RefusesBadOptions) {
  const TriangleMesh mesh = cube_mesh();
  EXPECT_THROW(hubbard_spheres({}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.counts = {}}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.counts = {0, 8}}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.counts = {8, 8}}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.sites = 0}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.cover_points = 0}), Error);
  EXPECT_THROW(hubbard_spheres(mesh, {.threads = -1}), Error);
}

}  // namespace
}  // namespace spherule::test
