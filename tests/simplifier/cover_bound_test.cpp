// SPDX-License-Identifier: BSD-3-Clause
// The bound from below on the count of any cover, and what it is made of: weights of points that no
// sphere may sum to more than one, held against many spheres taken at random.
#include "simplifier/stage2/bound/cover_bound.h"

#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Clearance;
using internal::ClearanceAt;
using internal::FractionalPacking;
using internal::HeaviestSpheres;

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

TEST(FractionalPacking, FindsWhatIsBestWherePointsDiffer) {
  // Twenty hubs, each in a set of its own with nine more points; one large set holds all but one
  // point of each. The twenty left out and one more may weigh 1 each.
  std::vector<Set> sets(20);
  Set large;
  for (std::uint32_t i = 0; i < 200; ++i) {
    sets[i / 10].push_back(i);
    if (i % 10 != 0) large.push_back(i);
  }
  sets.push_back(large);
  const std::vector<double> weights = packed(200, sets, 1200);
  EXPECT_LE(heaviest(sets, weights), 1.0 + 1e-12);
  EXPECT_NEAR(sum_of(weights), 20.0, 0.2);
}

TEST(FractionalPacking, WhatIsInNoSetWeighsNothing) {
  const std::vector<double> weights = packed(3, {{0}, {2}}, 60);
  EXPECT_EQ(weights[1], 0.0);
  EXPECT_NEAR(weights[0], 1.0, 1e-12);
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

TEST(CoverBound, IsEqualOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = l_bracket();
  const double max_error = 0.25 * diagonal_of(mesh);
  const auto bound = [&](int threads) {
    return bounded_cover(mesh, max_error, 4.0 * max_error, 0, threads).lower_bound;
  };
  const std::size_t alone = bound(1);
  for (const int threads : {0, 3}) EXPECT_EQ(bound(threads), alone);
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
