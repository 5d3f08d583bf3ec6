// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/medial_axis.h"

#include "base/error.h"
#include "bench/baseline/made_conservative.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/mesh_probe.h"
#include "bench/tests/baseline/cover_check.h"
#include "spheretree/check.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace spherule::test::medial_axis_test {
namespace {

using Eigen::Vector3d;
using internal::MedialSphere;

// Small enough to be quick.
const MedialSampling kCoarse = {
    .cover_points = 400, .cover_points_per_triangle = 1, .initial_sites = 120, .max_sites = 500};

TEST(MedialAxis, SpheresAreEmptyOfSitesAndTouchFour) {
  const TriangleMesh mesh = l_bracket();
  const internal::MeshProbe probe(mesh);
  internal::MedialAxis axis(probe, internal::even_samples(mesh, 150, 0, 3));
  for (int round = 0; round < 2; ++round) {
    ASSERT_GT(axis.spheres().size(), 20U);
    for (const MedialSphere& s : axis.spheres()) {
      int touching = 0;
      for (const Vector3d& site : axis.sites()) {
        const Real gap = gap_to_spheres(site, {&s.sphere, 1});
        ASSERT_GE(gap, -1e-8L);
        if (gap <= 1e-8L) ++touching;
      }
      EXPECT_GE(touching, 4);
      EXPECT_GT(s.clearance, 0.0);
    }
    axis.refine({.max_protrusion = 0.02, .min_spheres = 0, .max_sites = 600});
  }
}

double worst(const std::vector<MedialSphere>& spheres) {
  double largest = 0.0;
  for (const MedialSphere& s : spheres) largest = std::max(largest, s.protrusion());
  return largest;
}

TEST(MedialAxis, RefinementReachesTheProtrusionWithFewerSitesThanEvenOnes) {
  const TriangleMesh mesh = l_bracket();
  const internal::MeshProbe probe(mesh);
  internal::MedialAxis adaptive(probe, internal::even_samples(mesh, 100, 0, 3));
  EXPECT_GT(worst(adaptive.spheres()), 0.03);
  adaptive.refine({.max_protrusion = 0.01, .min_spheres = 0, .max_sites = 5000});
  EXPECT_LE(worst(adaptive.spheres()), 0.01);
  const internal::MedialAxis even(probe,
                                  internal::even_samples(mesh, adaptive.sites().size(), 0, 3));
  EXPECT_GT(worst(even.spheres()), 0.01);
}

TEST(MedialAxis, WatchedPointsAreReached) {
  const TriangleMesh mesh = cube_mesh();
  const internal::MeshProbe probe(mesh);
  const std::vector<Vector3d> watched = internal::cover_samples(mesh, 300, 1, 4);
  internal::MedialAxis axis(probe, internal::even_samples(mesh, 60, 0, 3), watched);
  axis.refine({.max_protrusion = 0.05, .min_spheres = 0, .max_sites = 5000});
  for (const Vector3d& p : watched) {
    Real gap = 1.0L;
    for (const MedialSphere& s : axis.spheres())
      gap = std::min(gap, gap_to_spheres(p, {&s.sphere, 1}));
    EXPECT_LE(gap, 0.05L);
  }
}

// Each mesh of the zoo, among them sheets, open and self-intersecting ones, needles and parts that
// are apart.
TEST(MedialAxis, CoversTheSamples) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    const MedialAxisSpheres result = medial_axis(named.mesh, {.spheres = 24, .sampling = kCoarse});
    EXPECT_LE(result.spheres.size(), 24U);
    const std::vector<Vector3d> samples = internal::cover_samples(
        named.mesh, kCoarse.cover_points, kCoarse.cover_points_per_triangle, kCoarse.seed);
    EXPECT_EQ(result.cover_points, samples.size());
    EXPECT_EQ(judge_cover(samples, result.spheres).uncovered, 0U);
  }
}

TEST(MedialAxis, CanBeMadeConservative) {
  const TriangleMesh mesh = slender(cube_mesh());
  const MedialAxisSpheres result = medial_axis(mesh, {.spheres = 24, .sampling = kCoarse});
  const ConservativeSpheres inflated = made_conservative(mesh, result.spheres);
  EXPECT_TRUE(inflated.certificate.covered);
  Random random(6);
  const auto dense = points_on_surface(mesh, 3000, random);
  EXPECT_EQ(judge_cover(dense, inflated.spheres).uncovered, 0U);
}

TEST(MedialAxis, BearsTinyFeaturesDistantPartsAndPlates) {
  const auto moved_by = [](const TriangleMesh& mesh, const Vector3d& by) {
    return moved(mesh, Eigen::Isometry3d(Eigen::Translation3d(by)));
  };
  const NamedMesh hard[] = {
      {"tiny box on a large one", joined(cube_mesh(), moved_by(cube_mesh(1e-5), {0.5, 0.5, 1.0}))},
      {"parts far from each other", joined(cube_mesh(), moved_by(cube_mesh(), {1000, 0, 0}))},
      {"a plate", thin_sheet(1e-6)},
      {"a sheet in one plane", TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
      {"triangles twice", with_duplicates(l_bracket())},
      {"far from the origin", moved_by(l_bracket(), {3e6, -2e6, 1e6})}};
  for (const NamedMesh& named : hard) {
    SCOPED_TRACE(named.name);
    for (const double wanted : {0.0, 0.1}) {
      const MedialAxisSpheres result =
          medial_axis(named.mesh, {.spheres = 10, .max_protrusion = wanted, .sampling = kCoarse});
      if (wanted > 0.0) {
        EXPECT_LE(result.protrusion, wanted * 1.0001);
      } else {
        EXPECT_LE(result.spheres.size(), 10U);
      }
      const std::vector<Vector3d> samples = internal::cover_samples(
          named.mesh, kCoarse.cover_points, kCoarse.cover_points_per_triangle, kCoarse.seed);
      EXPECT_EQ(judge_cover(samples, result.spheres).uncovered, 0U);
    }
  }
}

TEST(MedialAxis, FartherProtrusionNeedsFewerSpheres) {
  std::size_t before = 100000;
  for (const double wanted : {0.05, 0.1, 0.2}) {
    const MedialAxisSpheres result =
        medial_axis(cube_mesh(), {.max_protrusion = wanted, .sampling = kCoarse});
    EXPECT_LE(result.protrusion, wanted * (1 + 1e-12));
    EXPECT_LT(result.spheres.size(), before);
    before = result.spheres.size();
  }
}

TEST(MedialAxis, LevelsHoldTheSamplesAndMakeATree) {
  const TriangleMesh mesh = slender(l_bracket());
  const SphereLevels levels =
      medial_axis_tree(mesh, {.branching = 4, .depth = 3, .sampling = kCoarse});
  ASSERT_EQ(levels.levels.size(), 4U);
  const std::vector<Vector3d> samples = internal::cover_samples(
      mesh, kCoarse.cover_points, kCoarse.cover_points_per_triangle, kCoarse.seed);
  std::size_t most = 1;
  for (std::size_t k = 0; k < 4; ++k, most *= 4) {
    EXPECT_LE(levels.levels[k].size(), most);
    EXPECT_EQ(judge_cover(samples, levels.levels[k]).uncovered, 0U) << k;
    if (k == 0) continue;
    std::vector<int> children(levels.levels[k - 1].size(), 0);
    for (const std::int32_t p : levels.parents[k - 1]) ++children.at(static_cast<std::size_t>(p));
    EXPECT_LE(*std::max_element(children.begin(), children.end()), 4);
    EXPECT_GE(*std::min_element(children.begin(), children.end()), 1);
  }
  const ConservativeSpheres leaves = made_conservative(mesh, levels.levels.back());
  const LevelTree tree = enclosing_tree(levels, leaves.spheres);
  EXPECT_TRUE(check(tree.tree).valid);
}

TEST(MedialAxis, IsTheSameForEqualSeedOnAnyNumberOfThreads) {
  MedialAxisOptions options{.spheres = 20, .sampling = kCoarse, .threads = 1};
  const std::vector<Sphere> one = medial_axis(l_bracket(), options).spheres;
  options.threads = 3;
  EXPECT_EQ(medial_axis(l_bracket(), options).spheres, one);
  options.sampling.seed = 2;
  EXPECT_NE(medial_axis(l_bracket(), options).spheres, one);
}

TEST(MedialAxis, RefusesBadInput) {
  const TriangleMesh mesh = cube_mesh();
  EXPECT_THROW(medial_axis({}), Error);
  EXPECT_THROW(medial_axis({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), Error);
  EXPECT_THROW(medial_axis(mesh, {.spheres = 0}), Error);
  EXPECT_THROW(medial_axis(mesh, {.max_protrusion = -1.0}), Error);
  EXPECT_THROW(medial_axis(mesh, {.sampling = {.cover_points = 0}}), Error);
  EXPECT_THROW(medial_axis(mesh, {.sampling = {.initial_sites = 0}}), Error);
  EXPECT_THROW(medial_axis(mesh, {.sampling = {.error_factor = 0.0}}), Error);
  EXPECT_THROW(medial_axis(mesh, {.threads = -1}), Error);
  EXPECT_THROW(medial_axis_tree(mesh, {.branching = 1}), Error);
  EXPECT_THROW(medial_axis_tree(mesh, {.depth = 0}), Error);
}

}  // namespace
}  // namespace spherule::test::medial_axis_test
