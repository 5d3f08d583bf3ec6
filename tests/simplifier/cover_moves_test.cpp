// SPDX-License-Identifier: BSD-3-Clause
// The moves between two searches of cover() and what more of them are worth; large solids, which
// are covered block by block.
#include "simplifier/stage2/cover_moves.h"

#include "geometry/mesh_distance.h"
#include "simplifier/internal/stages.h"
#include "simplifier/simplify.h"
#include "simplifier/stage2/cover_blocks.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/stage2/cover_problem.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <stop_token>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Candidate;
using internal::cap_width;
using internal::cap_width_at;
using internal::Clearance;
using internal::ClearanceAt;
using internal::CoverBlocks;
using internal::CoverFitter;
using internal::CoverProblem;
using internal::greedy_set_cover;
using internal::inside_radius;
using internal::open_rows;
using internal::touched_by;

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

// Equal bits on every machine and any number of threads (G7).
template <class Call>
void expect_equal_everywhere(Call spheres, std::uint64_t hash) {
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    const std::uint64_t found = arena.execute([&] { return hash_of(spheres()); });
    EXPECT_EQ(found, hash) << "0x" << std::hex << found;
  }
}

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

TEST(CoverMoves, PerturbedSpheresAreEqualEverywhere) {
  Random random(14);
  const Scene scene(random);
  const CoverProblem::Columns solution = greedy_set_cover(scene.problem.instance());
  const auto spheres = [&](std::uint64_t seed) {
    std::vector<Sphere> found;
    for (const Candidate& c : perturbed(scene.clearance, scene.problem, solution, seed)) {
      found.push_back({c.center, c.clearance});
    }
    return found;
  };
  expect_equal_everywhere([&] { return spheres(1); }, 0x69d101c7b22b96b3U);
  EXPECT_NE(spheres(2), spheres(1));
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

// --- blocks ---
// Large solids are covered block by block; here blocks are small, so that small solids have some.

class Blocks : public testing::Test {
 protected:
  Blocks() : mesh_(l_bracket()) {
    options_.effort = 0;
    set_error((kSanitized ? 0.1 : 0.05) * diagonal_of(mesh_));
  }

  void set_error(double max_error) {
    options_.max_error = max_error;
    external_ = place_external_spheres(mesh_, {.min_external_diameter = 4.0 * options_.max_error,
                                               .max_error = options_.max_error});
  }

  // In about so many blocks.
  std::vector<Sphere> covered(std::size_t blocks) const {
    const MeshDistance distance(mesh_);
    const internal::Clearance clearance(external_);
    CoverFitter fitter(clearance, distance, options_);
    const std::size_t count = fitter.divided().size();
    return CoverBlocks(clearance, distance, options_, fitter.divided().boxes(), {},
                       count / blocks + 1)
        .run();
  }

  void expect_proved(const std::vector<Sphere>& spheres) const {
    CertifyOptions options{.external = &external_, .zones = options_.zones, .volume = false};
    options.resolution = proof_resolution(options_.max_error, diagonal_of(mesh_));
    options.protrusion_tolerance = 0.0;
    const Certificate certificate = certify(mesh_, spheres, options);
    EXPECT_TRUE(certificate.covered);
    EXPECT_LE(certificate.protrusion_over_simplified_max, options_.max_error);
    for (std::size_t i = 0; i < options_.zones.size(); ++i) {
      EXPECT_LE(certificate.protrusion_in_zones[i], options_.zones[i].max_error);
    }
  }

  TriangleMesh mesh_;
  ExternalSpheres external_;
  CoverOptions options_;
};

TEST_F(Blocks, CoverS) {
  for (const std::size_t blocks : {2U, 30U}) {
    SCOPED_TRACE(blocks);
    expect_proved(covered(blocks));
  }
}

// A block covers what its spheres meet beyond it, too, before they are replaced.
TEST_F(Blocks, CoverSAfterASearchWithNoMoreSpheres) {
  for (const std::size_t blocks : effort(std::vector<std::size_t>{3, 30}, 1)) {
    SCOPED_TRACE(blocks);
    options_.effort = 0;
    options_.on_proved = {};
    const std::size_t first = covered(blocks).size();
    std::vector<std::size_t> counts;
    options_.effort = effort(4, 2);
    options_.on_proved = [&](std::size_t count) { counts.push_back(count); };
    const std::vector<Sphere> searched = covered(blocks);
    expect_proved(searched);
    ASSERT_FALSE(counts.empty());
    EXPECT_EQ(counts.front(), first);
    EXPECT_EQ(counts.back(), searched.size());
    EXPECT_TRUE(std::ranges::is_sorted(counts, std::greater<>()));
    if (!kSanitized) {
      EXPECT_LT(searched.size(), first);
    }
  }
}

TEST_F(Blocks, TakeFewMoreSpheresThanOneSearch) {
  const auto whole = static_cast<double>(covered(1).size());
  // Seams, and what chance does with the few spheres of a coarse cover.
  EXPECT_LE(static_cast<double>(covered(3).size()), 1.2 * whole + 5.0);
}

TEST_F(Blocks, AreEqualEverywhere) {
  set_error(0.1 * diagonal_of(mesh_));
  options_.effort = 2;
  expect_equal_everywhere([&] { return covered(9); }, 0xca11962f3252bf80U);
}

TEST_F(Blocks, KeepZonesOfTheirOwnError) {
  options_.zones = {{.shape = Sphere{mesh_.vertices.front(), 2.0 * options_.max_error},
                     .max_error = 0.5 * options_.max_error}};
  const std::vector<Sphere> spheres = covered(4);
  expect_proved(spheres);
}

TEST_F(Blocks, StopAfterTheFirstAnswerAtTheEarliest) {
  const std::vector<Sphere> first = covered(6);
  options_.effort = 1000000;
  options_.seconds = 1e-3;
  EXPECT_EQ(covered(6), first);
  options_.seconds = 0.0;
  std::stop_source stop;
  options_.stop = stop.get_token();
  options_.on_proved = [&](std::size_t) { stop.request_stop(); };
  EXPECT_EQ(covered(6), first);
  options_.on_proved = {};
  EXPECT_EQ(covered(6), first);
}

// Of cover(), where there are more cells than it is told.
TEST_F(Blocks, AreUsedForSolidsOfManyCells) {
  const MeshDistance distance(mesh_);
  const internal::Clearance clearance(external_);
  options_.lower_bound = true;
  const SphereCover in_blocks = internal::cover(mesh_, distance, clearance, options_, 1000);
  expect_proved(in_blocks.spheres);
  EXPECT_EQ(in_blocks.spheres, covered(1));
  EXPECT_EQ(in_blocks.lower_bound, 0U);
}

// One that nothing is left to cover for: the spheres are larger than the blocks.
TEST_F(Blocks, MayNeedNoSpheres) {
  options_.min_radius = 0.3 * diagonal_of(mesh_);
  options_.effort = 1;
  const std::vector<Sphere> spheres = covered(30);
  EXPECT_LT(spheres.size(), 15U);
  const CertifyOptions options{.external = &external_, .volume = false};
  EXPECT_TRUE(certify(mesh_, spheres, options).covered);
}

// What the progress throws ends all blocks, in the first answer and in the search.
TEST_F(Blocks, EndWithWhatIsThrown) {
  options_.effort = 2;
  for (const int calls : {2, 20}) {
    std::atomic<int> count = 0;
    options_.progress = [&](double, const char*) {
      if (++count == calls) throw std::runtime_error("enough");
    };
    EXPECT_THROW(covered(12), std::runtime_error) << calls;
  }
}

TEST_F(Blocks, ReportTheShareThatIsDone) {
  options_.effort = 1;
  std::vector<double> shares;
  options_.progress = [&](double share, const char* what) {
    EXPECT_STRNE(what, "");
    shares.push_back(share);
  };
  options_.threads = 1;
  tbb::task_arena arena(1);
  arena.execute([&] { covered(6); });
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.size(), 12U);
  EXPECT_EQ(shares.back(), 1.0);
}

// --- surface extent ---

constexpr double kSize = 100.0;
constexpr double kCapError = 1.0;

// S is a cube.
struct Box {
  ExternalSpheres external;
  Clearance clearance;

  Box() : external(make()), clearance(external) {}
  static ExternalSpheres make() {
    ExternalSpheres made;
    made.box = {Vector3d::Zero(), Vector3d::Constant(kSize)};
    return made;
  }
};

TEST(SurfaceExtent, ACapIsAsWideAsItsGeometrySays) {
  for (const double inside : {0.0, 0.3, 5.0, 400.0}) {
    const double width = cap_width(inside, kCapError);
    // A corner of the cap is on the sphere of radius inside + E.
    EXPECT_NEAR(std::hypot(inside, width), inside + kCapError, 1e-9);
    EXPECT_NEAR(inside_radius(width, kCapError), inside, 1e-9);
  }
}

TEST(SurfaceExtent, SpheresThatTouchNearAnEdgeAreNoLargerThanTheWayToIt) {
  const Box box;
  int judged = 0;
  for (const double to_edge : {0.0, 2.0, 10.0, 45.0}) {
    for (const double depth : {-0.5, 0.0, 1.0}) {
      SCOPED_TRACE(testing::Message() << to_edge << " " << depth);
      const Vector3d point(50.0, to_edge, depth);
      const ClearanceAt at = box.clearance(point);
      // Two of the points on the edge or beside it are as near to the other face, or nearer.
      if (depth > to_edge || at.away != Vector3d::UnitZ()) continue;
      ++judged;
      EXPECT_TRUE(touched_by(box.clearance, point, at, to_edge, kCapError));
      EXPECT_FALSE(touched_by(box.clearance, point, at, to_edge + 0.5, kCapError));
      const double width = cap_width_at(box.clearance, point, at, kCapError);
      EXPECT_LE(width, cap_width(to_edge + 0.5, kCapError));
      EXPECT_GE(width * 1.4, std::min(cap_width(to_edge, kCapError), 15.0));
    }
  }
  EXPECT_EQ(judged, 10);
}

}  // namespace
}  // namespace spherule::test
