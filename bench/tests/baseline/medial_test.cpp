// SPDX-License-Identifier: BSD-3-Clause
// Voronoi vertices, AMAA and Hubbard's spheres.
#include "base/error.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/tests/baseline/cover_check.h"
#include "spheretree/sphere_tree.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::MedialSphere;
using internal::voronoi_vertices;
using internal::VoronoiVertex;
using Vector3l = Eigen::Matrix<Real, 3, 1>;

Eigen::AlignedBox3d unit_box() {
  return {Vector3d::Zero(), Vector3d::Ones()};
}

std::vector<Vector3d> random_sites(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector3d> sites;
  for (std::size_t i = 0; i < count; ++i) sites.push_back(random.in_box(unit_box()));
  return sites;
}

// By all distances, in extended precision: no site is inside, and at least four are on the
// boundary.
void expect_empty_and_touching(const std::vector<Vector3d>& sites, double tolerance) {
  for (const VoronoiVertex& v : voronoi_vertices(sites)) {
    int touching = 0;
    for (const Vector3d& site : sites) {
      const Real gap =
          (site.cast<Real>() - v.point.cast<Real>()).norm() - static_cast<Real>(v.radius);
      ASSERT_GE(gap, -tolerance);
      if (gap <= tolerance) ++touching;
    }
    EXPECT_GE(touching, 4);
  }
}

// Every set of four sites in turn: those whose sphere is empty, and centre in the box of the sites.
std::vector<std::array<std::uint32_t, 4>> all_empty_spheres(const std::vector<Vector3d>& sites) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : sites) box.extend(p);
  std::vector<std::array<std::uint32_t, 4>> found;
  const auto count = static_cast<std::uint32_t>(sites.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      for (std::uint32_t c = b + 1; c < count; ++c) {
        for (std::uint32_t d = c + 1; d < count; ++d) {
          // The centre is equally far from a and each of the others.
          Eigen::Matrix<Real, 3, 3> rows;
          Vector3l right;
          const Vector3l first = sites[a].cast<Real>();
          int k = 0;
          for (const std::uint32_t other : {b, c, d}) {
            const Vector3l edge = sites[other].cast<Real>() - first;
            rows.row(k) = edge.transpose();
            right[k++] = edge.squaredNorm() / 2;
          }
          const Vector3l offset = rows.inverse() * right;
          const Vector3l center = first + offset;
          if (!box.contains(center.cast<double>())) continue;
          const bool empty = std::all_of(sites.begin(), sites.end(), [&](const Vector3d& p) {
            return (p.cast<Real>() - center).norm() >= offset.norm() * (1 - 1e-12L);
          });
          if (empty) found.push_back({a, b, c, d});
        }
      }
    }
  }
  return found;
}

TEST(Voronoi, FindsEveryEmptySphereInTheBox) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    const std::vector<Vector3d> sites = random_sites(24, seed);
    std::vector<std::array<std::uint32_t, 4>> found;
    for (const VoronoiVertex& v : voronoi_vertices(sites)) found.push_back(v.sites);
    EXPECT_EQ(found, all_empty_spheres(sites));
  }
}

TEST(Voronoi, BearsManySitesOnOneSphere) {
  std::vector<Vector3d> grid;
  for (int i = 0; i < 64; ++i) grid.emplace_back(i % 4, i / 4 % 4, i / 16);
  expect_empty_and_touching(grid, 1e-8);
  std::vector<VoronoiVertex> vertices = voronoi_vertices(grid);
  // The middles of the 27 cubes and nothing else.
  std::sort(vertices.begin(), vertices.end(), [](const VoronoiVertex& a, const VoronoiVertex& b) {
    return std::lexicographical_compare(a.point.begin(), a.point.end(), b.point.begin(),
                                        b.point.end());
  });
  std::vector<Vector3d> places;
  for (const VoronoiVertex& v : vertices) {
    const auto is_known = [&](const Vector3d& p) { return (p - v.point).norm() < 1e-6; };
    if (std::none_of(places.begin(), places.end(), is_known)) places.push_back(v.point);
  }
  EXPECT_EQ(places.size(), 27U);
}

TEST(Voronoi, BearsSitesThatOccurTwice) {
  std::vector<Vector3d> sites = random_sites(60, 8);
  const std::size_t count = voronoi_vertices(sites).size();
  sites.insert(sites.end(), sites.begin(), sites.begin() + 30);
  expect_empty_and_touching(sites, 1e-8);
  EXPECT_EQ(voronoi_vertices(sites).size(), count);
}

TEST(Voronoi, HasNothingToSayWithoutTetrahedra) {
  EXPECT_TRUE(voronoi_vertices({}).empty());
  EXPECT_TRUE(voronoi_vertices(std::vector<Vector3d>(9, Vector3d::Ones())).empty());
  std::vector<Vector3d> flat = random_sites(50, 9);
  for (Vector3d& p : flat) p.z() = 0.25;
  EXPECT_TRUE(voronoi_vertices(flat).empty());
  std::vector<Vector3d> line = random_sites(50, 10);
  for (Vector3d& p : line) p = Vector3d::Constant(p.x());
  EXPECT_TRUE(voronoi_vertices(line).empty());
}

TEST(Voronoi, BearsSitesFarFromTheOrigin) {
  std::vector<Vector3d> sites = random_sites(200, 11);
  const std::size_t count = voronoi_vertices(sites).size();
  for (Vector3d& p : sites) p += Vector3d(1e7, -2e7, 3e7);
  expect_empty_and_touching(sites, 1e-6);
  EXPECT_NEAR(static_cast<double>(voronoi_vertices(sites).size()), static_cast<double>(count),
              0.02 * static_cast<double>(count));
}

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

std::vector<Vector3d> samples_of(const TriangleMesh& mesh) {
  return internal::cover_samples(mesh, kCoarse.cover_points, kCoarse.cover_points_per_triangle,
                                 kCoarse.seed);
}

constexpr SphereReduction kReductions[] = {SphereReduction::kMerge, SphereReduction::kBurst,
                                           SphereReduction::kExpand};

// Each mesh of the zoo, among them sheets, open and self-intersecting ones, needles and parts that
// are apart.
TEST(MedialAxis, CoversTheSamples) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    const std::vector<Vector3d> samples = samples_of(named.mesh);
    for (const SphereReduction reduction : kReductions) {
      for (const std::size_t count : {1U, 24U}) {
        SCOPED_TRACE(named.name + " to " + std::to_string(count));
        const MedialAxisSpheres result = medial_axis(
            named.mesh, {.spheres = count, .reduction = reduction, .sampling = kCoarse});
        EXPECT_LE(result.spheres.size(), count);
        EXPECT_EQ(result.cover_points, samples.size());
        EXPECT_EQ(judge_cover(samples, result.spheres).uncovered, 0U);
      }
    }
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
      EXPECT_EQ(judge_cover(samples_of(named.mesh), result.spheres).uncovered, 0U);
    }
  }
}

// Points of the spheres' surfaces, against the distance to the cube by brute force.
TEST(MedialAxis, ProtrudesNoMoreThanWanted) {
  const TriangleMesh mesh = cube_mesh();
  const Eigen::AlignedBox3d cube(Vector3d::Zero(), Vector3d::Ones());
  Random random(5);
  for (const SphereReduction reduction : kReductions) {
    std::size_t before = 100000;
    for (const double wanted : {0.1, 0.2, 0.4}) {
      const MedialAxisSpheres result = medial_axis(
          mesh, {.max_protrusion = wanted, .reduction = reduction, .sampling = kCoarse});
      EXPECT_LE(result.protrusion, wanted * (1 + 1e-12));
      for (const Sphere& s : result.spheres) {
        for (int k = 0; k < 50; ++k) {
          const Vector3d p = s.center + s.radius * random.direction();
          EXPECT_LE(cube.exteriorDistance(p), wanted * (1 + 1e-12));
        }
      }
      EXPECT_LT(result.spheres.size(), before);
      before = result.spheres.size();
    }
  }
}

TEST(MedialAxis, LevelsHoldTheSamplesAndMakeATree) {
  const TriangleMesh mesh = slender(l_bracket());
  const SphereLevels levels =
      medial_axis_tree(mesh, {.branching = 4, .depth = 3, .sampling = kCoarse});
  ASSERT_EQ(levels.levels.size(), 4U);
  const std::vector<Vector3d> samples = samples_of(mesh);
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

const HubbardOptions kFew = {.counts = {1, 6, 30}, .sites = 150, .cover_points = 400};

TEST(HubbardSpheres, EveryLevelHoldsTheSamples) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    const SphereLevels levels = hubbard_spheres(named.mesh, kFew);
    ASSERT_EQ(levels.levels.size(), 3U);
    ASSERT_EQ(levels.parents.size(), 2U);
    const auto samples = internal::cover_samples(named.mesh, kFew.cover_points, 1, kFew.seed);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(levels.levels[k].size(), kFew.counts[k]);
      EXPECT_EQ(judge_cover(samples, levels.levels[k]).uncovered, 0U);
    }
  }
}

TEST(HubbardSpheres, ReachesTheWantedCounts) {
  const SphereLevels levels = hubbard_spheres(l_bracket(), kFew);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(levels.levels[k].size(), kFew.counts[k]);
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
  const SphereLevels levels = hubbard_spheres(mesh, kFew);
  const ConservativeSpheres leaves = made_conservative(mesh, levels.levels.back());
  EXPECT_TRUE(leaves.certificate.covered);
  const LevelTree tree = enclosing_tree(levels, leaves.spheres);
  EXPECT_TRUE(check(tree.tree).valid);
  // Each sphere of a level stands in the tree and is no smaller than it was.
  ASSERT_EQ(tree.nodes.size(), 2U);
}

TEST(HubbardSpheres, EnclosingTreeRefusesWhatDoesNotAgree) {
  SphereLevels levels = hubbard_spheres(l_bracket(), kFew);
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
  HubbardOptions options = kFew;
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
