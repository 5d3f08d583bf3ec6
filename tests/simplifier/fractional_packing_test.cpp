// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/bound/cover_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace spherule::internal {
namespace {

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

}  // namespace
}  // namespace spherule::internal
