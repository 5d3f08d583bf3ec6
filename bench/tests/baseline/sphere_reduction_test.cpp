// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/sphere_reduction.h"

#include "bench/baseline/mesh_probe.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::FittedSphere;
using internal::ReductionGoal;
using internal::ReductionTask;

// A mesh with its samples and medial spheres.
struct Problem {
  explicit Problem(const TriangleMesh& mesh, std::size_t sites = 150)
      : probe(mesh),
        samples(internal::cover_samples(mesh, 400, 1, 1)),
        axis(probe, internal::even_samples(mesh, sites, 0, 2)),
        points(samples.size()) {
    std::iota(points.begin(), points.end(), 0U);
  }
  ReductionTask task() const { return {probe, samples, points, axis.spheres()}; }

  internal::MeshProbe probe;
  std::vector<Vector3d> samples;
  internal::MedialAxis axis;
  std::vector<std::uint32_t> points;
};

std::vector<Sphere> spheres_of(const std::vector<FittedSphere>& fitted) {
  std::vector<Sphere> spheres;
  for (const FittedSphere& s : fitted) spheres.push_back(s.sphere);
  return spheres;
}

// Each point of the task belongs to one sphere, which holds it; judged in extended precision.
void expect_points_held(const Problem& problem, const std::vector<FittedSphere>& spheres) {
  std::vector<std::uint32_t> held;
  for (const FittedSphere& s : spheres) {
    EXPECT_FALSE(s.points.empty());
    for (const std::uint32_t p : s.points) {
      EXPECT_LE(gap_to_spheres(problem.samples[p], {&s.sphere, 1}), 0.0L);
      held.push_back(p);
    }
  }
  std::sort(held.begin(), held.end());
  EXPECT_EQ(held, problem.points);
}

// Points of the spheres' surfaces, against the distance to a convex mesh by brute force.
double sampled_protrusion(const TriangleMesh& mesh, const Problem& problem,
                          const std::vector<FittedSphere>& spheres) {
  Random random(5);
  Real worst = 0.0L;
  for (const FittedSphere& s : spheres) {
    for (int k = 0; k < 50; ++k) {
      const Vector3d p = s.sphere.center + s.sphere.radius * random.direction();
      if (problem.probe.is_inside(p)) continue;
      worst = std::max(worst, judged_mesh_distance(p, mesh));
    }
  }
  return static_cast<double>(worst);
}

using Reduce = std::vector<FittedSphere> (*)(const ReductionTask&, const ReductionGoal&);
constexpr Reduce kReductions[] = {internal::merge, internal::burst, internal::expand};

TEST(SphereReduction, HoldsAllPointsWithTheWantedCount) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    const Problem problem(named.mesh);
    for (const Reduce reduce : kReductions) {
      for (const std::size_t count : {1U, 7U, 40U}) {
        SCOPED_TRACE(named.name + " to " + std::to_string(count));
        const std::vector<FittedSphere> spheres = reduce(problem.task(), {.count = count});
        EXPECT_LE(spheres.size(), count);
        EXPECT_GE(spheres.size(), 1U);
        expect_points_held(problem, spheres);
      }
    }
  }
}

TEST(SphereReduction, ProtrudesNoMoreThanWanted) {
  const TriangleMesh mesh = cube_mesh();
  const Problem problem(mesh, 400);
  for (const Reduce reduce : kReductions) {
    std::size_t before = problem.points.size() + 1;
    for (const double wanted : {0.15, 0.3, 0.45}) {
      const std::vector<FittedSphere> spheres = reduce(problem.task(), {.max_protrusion = wanted});
      expect_points_held(problem, spheres);
      EXPECT_LE(internal::largest_protrusion(spheres), wanted * (1 + 1e-12));
      EXPECT_LE(sampled_protrusion(mesh, problem, spheres), wanted * (1 + 1e-12));
      EXPECT_LT(spheres.size(), before);
      before = spheres.size();
    }
  }
}

TEST(SphereReduction, ManyMedialSpheresBecomeFewOfThem) {
  // A sphere of the solid alone: one of its medial spheres holds nearly all of it.
  const Problem problem(icosphere(2));
  for (const Reduce reduce : kReductions) {
    const std::vector<FittedSphere> one = reduce(problem.task(), {.count = 1});
    ASSERT_EQ(one.size(), 1U);
    EXPECT_LT(one[0].sphere.radius, 1.25);
    EXPECT_GE(one[0].sphere.radius, 0.99);
  }
}

TEST(SphereReduction, MergedLevelsHoldWhatBecamePartOfThem) {
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    const Problem problem(named.mesh);
    const std::size_t counts[] = {60, 8, 1};
    const auto levels = internal::merge_levels(problem.task(), counts);
    ASSERT_EQ(levels.size(), 3U);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      EXPECT_LE(levels[k].size(), counts[k]);
      expect_points_held(problem, levels[k]);
      if (k + 1 == levels.size()) continue;
      std::vector<std::vector<std::uint32_t>> merged(levels[k + 1].size());
      for (const FittedSphere& s : levels[k]) {
        auto& into = merged.at(static_cast<std::size_t>(s.merged_into));
        into.insert(into.end(), s.points.begin(), s.points.end());
      }
      for (std::size_t i = 0; i < merged.size(); ++i) {
        std::sort(merged[i].begin(), merged[i].end());
        EXPECT_EQ(merged[i], levels[k + 1][i].points);
      }
    }
  }
}

TEST(SphereReduction, IsTheSameOnAnyNumberOfThreadsAndTwice) {
  const Problem problem(l_bracket());
  for (const Reduce reduce : kReductions) {
    EXPECT_EQ(spheres_of(reduce(problem.task(), {.count = 12})),
              spheres_of(reduce(problem.task(), {.count = 12})));
  }
}

}  // namespace
}  // namespace spherule::test
