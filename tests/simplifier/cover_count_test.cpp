// SPDX-License-Identifier: BSD-3-Clause
// How many spheres a cover takes: what more rounds of the search of cover() are worth; large
// solids, which are covered block by block; the bound from below on the count.
#include "geometry/mesh_distance.h"
#include "simplifier/internal/stages.h"
#include "simplifier/simplify.h"
#include "simplifier/stage2/bound/cover_bound.h"
#include "simplifier/stage2/cover_blocks.h"
#include "simplifier/stage2/cover_fitter.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>
#include <stop_token>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Clearance;
using internal::ClearanceAt;
using internal::CoverBlocks;
using internal::CoverFitter;
using internal::FractionalPacking;
using internal::HeaviestSpheres;

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
    const Clearance clearance(external_);
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

// Equal bits on every machine and any number of threads (G7).
TEST_F(Blocks, AreEqualEverywhere) {
  set_error(0.1 * diagonal_of(mesh_));
  options_.effort = 2;
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    const std::uint64_t found = arena.execute([&] { return hash_of(covered(9)); });
    EXPECT_EQ(found, 0xca11962f3252bf80U) << "0x" << std::hex << found;
  }
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
  const Clearance clearance(external_);
  options_.lower_bound = true;
  const SphereCover in_blocks = internal::cover(mesh_, distance, clearance, options_, 1000);
  expect_proved(in_blocks.spheres);
  EXPECT_EQ(in_blocks.spheres, covered(1));
  EXPECT_EQ(in_blocks.lower_bound, 0U);
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

// --- the bound from below on the count of any cover ---
// It is made of weights of points that no sphere may sum to more than one, held against many
// spheres taken at random.

using Set = FractionalPacking::Set;

double sum_of(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

double heaviest(const std::vector<Set>& sets, const std::vector<double>& weights) {
  double most = 0.0;
  for (const Set& set : sets) {
    double load = 0.0;
    for (const std::uint32_t p : set) load += weights[p];
    most = std::max(most, load);
  }
  return most;
}

std::vector<double> packed(std::size_t points, const std::vector<Set>& sets, int steps) {
  FractionalPacking packing(points);
  packing.add(sets);
  packing.solve(steps);
  return packing.weights();
}

// Runs of `length` of the points about a circle: by symmetry each weighs 1 / length at the best.
std::vector<Set> arcs(std::uint32_t points, std::uint32_t length) {
  std::vector<Set> sets(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    for (std::uint32_t k = 0; k < length; ++k) sets[i].push_back((i + k) % points);
  }
  return sets;
}

TEST(FractionalPacking, FindsTheBestOfArcs) {
  for (const std::uint32_t length : {2U, 3U, 7U}) {
    const std::vector<Set> sets = arcs(31, length);
    const std::vector<double> weights = packed(31, sets, 600);
    EXPECT_LE(heaviest(sets, weights), 1.0 + 1e-12);
    EXPECT_NEAR(sum_of(weights), 31.0 / length, 0.01 * 31.0 / length);
  }
}

TEST(FractionalPacking, KeepsToSetsThatComeLater) {
  std::mt19937 random(1);
  std::vector<Set> sets;
  FractionalPacking packing(100);
  for (int round = 0; round < 3; ++round) {
    std::vector<Set> more(50);
    for (Set& set : more) {
      for (std::uint32_t p = 0; p < 100; ++p) {
        if (random() % 8 == 0) set.push_back(p);
      }
    }
    sets.insert(sets.end(), more.begin(), more.end());
    packing.add(more);
    packing.solve(100);
    EXPECT_LE(heaviest(sets, packing.weights()), 1.0 + 1e-12);
    EXPECT_GT(sum_of(packing.weights()), 1.0);
  }
}

// --- the heaviest spheres that may cover a solid ---

void expect_none_heavier(const TriangleMesh& mesh, double max_error, double diameter) {
  const Clearance clearance(
      place_external_spheres(mesh, {.min_external_diameter = diameter, .max_error = max_error}));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto point_in = [&](double inflated) -> Vector3d {
    const Vector3d by = Vector3d::Constant(inflated);
    const Vector3d share(unit(random), unit(random), unit(random));
    return clearance.box().min() - by +
           share.cwiseProduct(Vector3d(clearance.box().sizes() + 2.0 * by));
  };
  std::vector<Vector3d> points;
  std::vector<double> weights;
  while (points.size() < 800) {
    // Onto the boundary of S, along which what spheres hold differs most.
    Vector3d p = point_in(0.0);
    const ClearanceAt at = clearance(p);
    if (at.lower < 0.0) continue;
    p -= at.away * at.lower;
    points.push_back(p);
    weights.push_back(unit(random) < 0.7 ? 0.0 : 0.2 * unit(random));
  }
  const HeaviestSpheres spheres(clearance, max_error, points);
  const HeaviestSpheres::Found found =
      spheres.find({.weights = weights, .finest = 0.1 * max_error, .news = 1.05});
  double heaviest = 0.0;
  for (int i = 0; i < effort(8000, 500); ++i) {
    Vector3d center = point_in(max_error);
    ClearanceAt at = clearance(center);
    // Away from the contact spheres grow, up to the medial axis.
    for (int step = 0; step < i % 4; ++step) {
      center += unit(random) * max_error * at.away;
      at = clearance(center);
    }
    const double radius = at.lower + max_error;
    double weight = 0.0;
    double divided = 0.0;
    double about = 1e9;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if ((points[k] - center).norm() > radius) continue;
      weight += weights[k];
      divided += weights[k] / found.about[k];
      about = std::min(about, found.about[k]);
    }
    EXPECT_LE(weight, about * (1.0 + 1e-9));
    EXPECT_LE(divided, 1.0 + 1e-9);
    heaviest = std::max(heaviest, weight);
  }
  // The spheres tried are heavy, and what is said of them is not idle.
  EXPECT_GT(heaviest, 1.2);
  EXPECT_LT(*std::max_element(found.about.begin(), found.about.end()), 1.5 * heaviest);
  EXPECT_FALSE(found.held.empty());
}

TEST(HeaviestSpheres, NoneIsHeavierThanSaid) {
  expect_none_heavier(cube_mesh(), 0.15, 1.0);
  const double diagonal = diagonal_of(l_bracket());
  expect_none_heavier(l_bracket(), 0.06 * diagonal, 0.2 * diagonal);
}

// --- the bound ---

SphereCover bounded_cover(const TriangleMesh& mesh, double diameter, CoverOptions options) {
  const ExternalSpheres external = place_external_spheres(
      mesh, {.min_external_diameter = diameter, .max_error = options.max_error});
  options.lower_bound = true;
  return cover(mesh, external, options);
}

SphereCover bounded_cover(const TriangleMesh& mesh, double max_error, double diameter,
                          int rounds = 0, int threads = 0) {
  return bounded_cover(mesh, diameter,
                       {.max_error = max_error, .effort = rounds, .threads = threads});
}

TEST(CoverBound, IsAboveWhatIsEasyAndNeverAboveACover) {
  // A sphere within E of a bar of 1 x 0.01 x 0.01 has a radius of at most E and half the diagonal
  // of its section: it holds no more than twice as much of the length.
  for (const double max_error : {0.12, 0.1, 0.07}) {
    const SphereCover bar = bounded_cover(box_mesh({0, 0, 0}, {1, 0.01, 0.01}), max_error, 1.0);
    EXPECT_GE(static_cast<double>(bar.lower_bound), 1.0 / (2.0 * max_error + 0.01 * 1.4143));
    EXPECT_LE(bar.lower_bound, bar.spheres.size());
  }
  if (kSanitized) return;
  // Of a plate of 1 x 1 x 0.05 it holds a circle of a radius of at most E + 0.025.
  const double max_error = 0.176;
  const SphereCover plate = bounded_cover(box_mesh({0, 0, 0}, {1, 1, 0.05}), max_error, 1.0);
  EXPECT_GE(static_cast<double>(plate.lower_bound),
            1.0 / (std::numbers::pi * std::pow(max_error + 0.025, 2)));
  EXPECT_LE(plate.lower_bound, plate.spheres.size());
  // Any cover of a cube needs a sphere for each of the eight corners: they are 4 E apart, and a
  // sphere reaches 2.83 E along an edge.
  const SphereCover cube = bounded_cover(cube_mesh(), 0.25, 1.0);
  EXPECT_GE(cube.lower_bound, 8U);
  EXPECT_LE(cube.lower_bound, cube.spheres.size());
}

TEST(CoverBound, IsOneWhereOneSphereDoes) {
  const SphereCover cube = bounded_cover(cube_mesh(), 0.5, 2.0, 4);
  EXPECT_EQ(cube.spheres.size(), 1U);
  EXPECT_EQ(cube.lower_bound, 1U);
}

TEST(CoverBound, StaysBelowTheCountOfEveryShape) {
  int above_one = 0;
  for (const auto& [name, mesh] : zoo_to_fit()) {
    SCOPED_TRACE(name);
    const double max_error = 0.3 * diagonal_of(mesh);
    const SphereCover result = bounded_cover(mesh, max_error, 4.0 * max_error);
    EXPECT_GE(result.lower_bound, 1U);
    EXPECT_LE(result.lower_bound, result.spheres.size());
    above_one += result.lower_bound > 1U;
  }
  EXPECT_GT(above_one, 0);
}

TEST(CoverBound, IsUnknownWhereItWouldNotHold) {
  const TriangleMesh mesh = cube_mesh();
  const ExternalSpheres external =
      place_external_spheres(mesh, {.min_external_diameter = 1.0, .max_error = 0.2});
  EXPECT_EQ(cover(mesh, external, {.max_error = 0.2, .effort = 0}).lower_bound, 0U);
  const CoverOptions with_radius{.max_error = 0.2, .min_radius = 0.5, .effort = 0};
  EXPECT_EQ(bounded_cover(mesh, 1.0, with_radius).lower_bound, 0U);
  // An external sphere smaller than E may lie wholly within E of S.
  EXPECT_EQ(cover(mesh, external, {.max_error = 0.6, .effort = 0, .lower_bound = true}).lower_bound,
            1U);
}

}  // namespace
}  // namespace spherule::test
