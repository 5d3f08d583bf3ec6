// SPDX-License-Identifier: BSD-3-Clause
// The moves between two searches of cover(), and what more of them are worth.
#include "simplifier/stage2/cover_moves.h"

#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/sphere_hash.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Candidate;
using internal::Clearance;
using internal::CoverProblem;
using internal::greedy_set_cover;
using internal::open_rows;

constexpr double kError = 0.1;

// The unit cube, candidates all through it, and rows on its surface.
struct Scene {
  ExternalSpheres external = externals_of(cube(), {.max_error = kError / diagonal_of(cube())});
  Clearance clearance{external};
  CoverProblem problem{kError, 0.0};

  explicit Scene(Random& random) {
    std::vector<CoverProblem::Row> rows;
    for (const Vector3d& p : points_on_surface(cube(), 2000, random)) {
      rows.push_back({p, 0.02 * kError});
    }
    problem.add_rows(rows);
    std::vector<Candidate> candidates;
    while (candidates.size() < 3000) {
      const Vector3d p = random.in_box({Vector3d(0, 0, 0), Vector3d(1, 1, 1)});
      const double lower = clearance(p).lower;
      if (lower >= 0.0) candidates.push_back({p, lower});
    }
    for (const CoverProblem::Row& row : problem.rows()) {
      candidates.push_back({row.point, std::max(0.0, clearance(row.point).lower)});
    }
    problem.add_candidates(candidates);
  }
  static TriangleMesh cube() { return mesh_named("cube"); }
};

double least_margin(const CoverProblem& problem, const Candidate& candidate,
                    const std::vector<std::uint32_t>& rows) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t row : rows) {
    least = std::min(least, problem.margin(candidate, problem.rows()[row]));
  }
  return least;
}

TEST(CoverMoves, ARowsSurroundingsAreADiscGrownByASphere) {
  Random random(13);
  const CoverProblem problem{kError, 0.0};
  for (int i = 0; i < 200; ++i) {
    const double disc = i % 4 == 0 ? 0.0 : random.between(0.0, 0.5);
    const CoverProblem::Row row{random.in_box({Vector3d(-1, -1, -1), Vector3d(1, 1, 1)}),
                                random.between(0.0, 0.1), disc, random.direction()};
    const Candidate candidate{i % 10 == 0
                                  ? Vector3d(row.point + 0.3 * row.normal)
                                  : random.in_box({Vector3d(-1, -1, -1), Vector3d(1, 1, 1)}),
                              random.between(0.0, 1.0)};
    const Vector3d across = row.normal.unitOrthogonal();
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3600; ++k) {
      const Eigen::AngleAxisd turn(k * 6.283185307179586 / 3600.0, row.normal);
      const Vector3d rim = row.point + row.disc * (turn * across);
      least =
          std::min(least, problem.radius(candidate) - row.radius - (rim - candidate.center).norm());
    }
    const double margin = problem.margin(candidate, row);
    EXPECT_LE(margin, least + 1e-12);
    EXPECT_GE(margin, least - 1e-5);
  }
}

TEST(CoverMoves, AShiftedSphereHasNoLessToSpareAndItsClearanceIsABound) {
  Random random(11);
  const Scene scene(random);
  int gained = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t c = random.index(scene.problem.instance().columns.size());
    const std::vector<std::uint32_t>& rows = scene.problem.instance().columns[c];
    if (rows.empty()) continue;
    const Candidate& start = scene.problem.candidate(c);
    const Candidate end = shift(scene.clearance, scene.problem, start, rows);
    const double before = least_margin(scene.problem, start, rows);
    const double after = least_margin(scene.problem, end, rows);
    EXPECT_GE(after, before - 1e-12);
    gained += after > before + 0.01 * kError;
    EXPECT_LE(end.clearance, scene.clearance(end.center).upper);
    EXPECT_GE(end.clearance, 0.0);
  }
  EXPECT_GT(gained, 50);
}

TEST(CoverMoves, SpreadingOpensNoRowAndGivesMoreToSpare) {
  Random random(12);
  Scene scene(random);
  CoverProblem::Columns solution = greedy_set_cover(scene.problem.instance());
  ASSERT_TRUE(open_rows(scene.problem.instance(), solution).empty());
  const CoverProblem::Columns before = solution;
  spread(scene.clearance, scene.problem, solution);
  EXPECT_EQ(solution.size(), before.size());
  EXPECT_TRUE(open_rows(scene.problem.instance(), solution).empty());
  EXPECT_NE(solution, before);
}

TEST(CoverMoves, SpheresReachForRowsThatAreOpen) {
  Random random(13);
  Scene scene(random);
  CoverProblem::Columns solution = greedy_set_cover(scene.problem.instance());
  solution.pop_back();
  const std::vector<std::uint32_t> open = open_rows(scene.problem.instance(), solution);
  ASSERT_FALSE(open.empty());
  const std::vector<Candidate> found = reach_for(scene.clearance, scene.problem, solution, open);
  ASSERT_FALSE(found.empty());
  const auto covers_one = [&](const Candidate& c) {
    return std::ranges::any_of(open, [&](std::uint32_t row) {
      return scene.problem.margin(c, scene.problem.rows()[row]) >= 0.0;
    });
  };
  EXPECT_TRUE(std::ranges::any_of(found, covers_one));
}

TEST(CoverMoves, PerturbedSpheresAreNewOnesOnTheMedialAxis) {
  Random random(14);
  const Scene scene(random);
  const CoverProblem::Columns solution = greedy_set_cover(scene.problem.instance());
  const std::vector<Candidate> found = perturbed(scene.clearance, scene.problem, solution, 1);
  EXPECT_LE(found.size(), solution.size());
  EXPECT_GE(2 * found.size(), solution.size());
  for (const Candidate& c : found) {
    EXPECT_GE(c.clearance, 0.0);
    EXPECT_LE(c.clearance, scene.clearance(c.center).upper);
    // Moving on, away from the contact, meets another one.
    const Vector3d on = c.center + 0.02 * kError * scene.clearance(c.center).away;
    EXPECT_LE(scene.clearance(on).lower, c.clearance + 0.017 * kError);
    EXPECT_TRUE(std::ranges::none_of(solution, [&](std::size_t column) {
      return scene.problem.candidate(column).center == c.center;
    }));
  }
}

// Equal bits on every machine and any number of threads (G7).
TEST(CoverMoves, PerturbedSpheresAreEqualEverywhere) {
  Random random(14);
  const Scene scene(random);
  const CoverProblem::Columns solution = greedy_set_cover(scene.problem.instance());
  const auto hash = [&](std::uint64_t seed, int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] {
      std::vector<Sphere> spheres;
      for (const Candidate& c : perturbed(scene.clearance, scene.problem, solution, seed)) {
        spheres.push_back({c.center, c.clearance});
      }
      return hash_of(spheres);
    });
  };
  EXPECT_EQ(hash(1, 1), 0x69d101c7b22b96b3U);
  EXPECT_EQ(hash(1, 4), hash(1, 1));
  EXPECT_NE(hash(2, 1), hash(1, 1));
}

TEST(CoverEffort, MoreOfItNeverTakesMoreSpheresAndIsProved) {
  for (const char* name : effort(std::vector{"cube", "l-bracket", "torus"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (const int rounds : {0, effort(4, 1), effort(16, 2)}) {
      const Fit fitted = fit(mesh, {}, {.effort = rounds});
      EXPECT_LE(fitted.cover.spheres.size(), least);
      EXPECT_TRUE(certificate_of(mesh, fitted, fitted.cover.spheres).covered);
      least = fitted.cover.spheres.size();
    }
  }
}

// Until cells and rows have become finer, with what was learned before.
TEST(CoverEffort, ALongSearchTakesFewerSpheresAndIsProved) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const char* name : {"cube", "l-bracket"}) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    const Fit quick = fit(mesh, {}, {.max_error = 0.06, .effort = 0});
    const Fit thorough = fit(mesh, {}, {.max_error = 0.06, .effort = 30});
    EXPECT_LT(thorough.cover.spheres.size(), quick.cover.spheres.size());
    EXPECT_TRUE(certificate_of(mesh, thorough, thorough.cover.spheres).covered);
  }
}

// A large thin part: more rows than candidates are grown for at once, and rows that were learned
// before cells become finer. A sphere about the middle plane protrudes by E above a disc of radius
// sqrt((E + 1/2)^2 - 1/4); the squares in these tile the plate.
TEST(CoverEffort, ALargeThinPlateTakesLittleMoreThanALattice) {
  struct Case {
    double max_error;
    int rounds;
    double most;  // times a lattice
  };
  const TriangleMesh mesh = box_mesh({0, 0, 0}, {200, 200, 1});
  const std::vector<Case> cases = kSanitized ? std::vector<Case>{{6.0, 4, 1.4}}
                                             : std::vector<Case>{{1.5, 0, 1.8}, {3.0, 10, 1.6}};
  for (const auto& [max_error, rounds, most] : cases) {
    SCOPED_TRACE(max_error);
    const ExternalSpheres external =
        place_external_spheres(mesh, {.min_external_diameter = 20.0, .max_error = max_error});
    const SphereCover fitted = cover(mesh, external, {.max_error = max_error, .effort = rounds});
    const double disc = (max_error + 0.5) * (max_error + 0.5) - 0.25;
    const double lattice = 200.0 * 200.0 / (2.0 * disc);
    EXPECT_LT(static_cast<double>(fitted.spheres.size()), most * lattice);
    EXPECT_GE(static_cast<double>(fitted.spheres.size()), 0.7 * lattice);
  }
}

TEST(CoverEffort, AnEndInTimeComesToAnEndAndIsProved) {
  const TriangleMesh mesh = mesh_named("l-bracket");
  CoverOptions options;
  options.seconds = 1e-3;
  const Fit fitted = fit(mesh, options, {.effort = std::numeric_limits<int>::max()});
  EXPECT_TRUE(certificate_of(mesh, fitted, fitted.cover.spheres).covered);
}

}  // namespace
}  // namespace spherule::test
