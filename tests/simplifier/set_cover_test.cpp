// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/cover_search.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace spherule::test {
namespace {

using internal::greedy_set_cover;
using internal::SetCoverInstance;
using Indices = std::vector<std::size_t>;

SetCoverInstance instance_of(std::size_t row_count,
                             const std::vector<std::vector<std::uint32_t>>& columns) {
  return {row_count, columns};
}

SetCoverInstance random_instance(Random& random, std::size_t rows, std::size_t columns,
                                 double density) {
  std::vector<std::vector<std::uint32_t>> sets(columns);
  for (std::vector<std::uint32_t>& set : sets) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      if (random.unit() < density) set.push_back(row);
    }
  }
  return instance_of(rows, sets);
}

std::set<std::uint32_t> rows_of(const SetCoverInstance& instance, const Indices& chosen) {
  std::set<std::uint32_t> rows;
  for (const std::size_t c : chosen) {
    const auto& column = instance.columns[c];
    rows.insert(column.begin(), column.end());
  }
  return rows;
}

Indices all_columns(const SetCoverInstance& instance) {
  Indices all(instance.columns.size());
  for (std::size_t c = 0; c < all.size(); ++c) all[c] = c;
  return all;
}

bool is_redundant(const SetCoverInstance& instance, const Indices& chosen, std::size_t which) {
  Indices others = chosen;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
  return rows_of(instance, others) == rows_of(instance, chosen);
}

// The least number of columns that cover what all of them cover, by trying every subset.
std::size_t least_cover(const SetCoverInstance& instance) {
  std::vector<std::uint32_t> masks;
  std::uint32_t wanted = 0;
  for (std::size_t c = 0; c < instance.columns.size(); ++c) {
    std::uint32_t mask = 0;
    for (const std::uint32_t row : instance.columns[c]) mask |= std::uint32_t{1} << row;
    masks.push_back(mask);
    wanted |= mask;
  }
  std::size_t least = masks.size();
  for (std::uint32_t subset = 0; subset < (std::uint32_t{1} << masks.size()); ++subset) {
    const auto size = static_cast<std::size_t>(std::popcount(subset));
    if (size >= least) continue;
    std::uint32_t covered = 0;
    for (std::size_t c = 0; c < masks.size(); ++c) {
      if ((subset >> c & 1U) != 0) covered |= masks[c];
    }
    if (covered == wanted) least = size;
  }
  return least;
}

TEST(SetCover, CoversWhatCanBeCoveredWithoutAnyRedundantColumn) {
  Random random(31);
  for (int i = 0; i < 300; ++i) {
    const SetCoverInstance instance =
        random_instance(random, 1 + random.index(80), random.index(60), random.between(0.0, 0.4));
    const Indices chosen = greedy_set_cover(instance);
    ASSERT_EQ(rows_of(instance, chosen), rows_of(instance, all_columns(instance)));
    ASSERT_EQ(std::set<std::size_t>(chosen.begin(), chosen.end()).size(), chosen.size());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      ASSERT_LT(chosen[k], instance.columns.size());
      ASSERT_FALSE(is_redundant(instance, chosen, k));
    }
    ASSERT_EQ(greedy_set_cover(instance), chosen);
  }
}

// The greedy algorithm as it is defined, every gain counted anew.
Indices plain_greedy(const SetCoverInstance& instance) {
  Indices chosen;
  while (true) {
    const std::set<std::uint32_t> covered = rows_of(instance, chosen);
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t c = 0; c < instance.columns.size(); ++c) {
      const auto gain = static_cast<std::size_t>(std::ranges::count_if(
          instance.columns[c], [&](std::uint32_t row) { return !covered.contains(row); }));
      if (gain > most) {
        most = gain;
        best = c;
      }
    }
    if (most == 0) break;
    chosen.push_back(best);
  }
  for (std::size_t k = chosen.size(); k-- > 0;) {
    if (is_redundant(instance, chosen, k)) {
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
  return chosen;
}

TEST(SetCover, TakesWhatThePlainGreedyAlgorithmTakes) {
  Random random(33);
  for (int i = 0; i < 60; ++i) {
    const SetCoverInstance instance = random_instance(random, 60, 50, random.between(0.05, 0.3));
    ASSERT_EQ(greedy_set_cover(instance), plain_greedy(instance));
  }
}

TEST(SetCover, IsWithinTheGreedyBoundOfTheLeast) {
  Random random(32);
  for (int i = 0; i < 150; ++i) {
    const SetCoverInstance instance = random_instance(
        random, 1 + random.index(20), 1 + random.index(12), random.between(0.1, 0.5));
    std::size_t largest = 1;
    for (std::size_t c = 0; c < instance.columns.size(); ++c) {
      largest = std::max(largest, instance.columns[c].size());
    }
    const std::size_t least = least_cover(instance);
    const std::size_t found = greedy_set_cover(instance).size();
    ASSERT_GE(found, least);
    ASSERT_LE(static_cast<double>(found),
              (1.0 + std::log(static_cast<double>(largest))) * static_cast<double>(least));
  }
}

TEST(SetCover, TakesTheLargestFirstAndTheLowestIndexOfEqualOnes) {
  EXPECT_EQ(greedy_set_cover(instance_of(4, {{0, 1}, {2, 3}, {2, 3}, {0, 1}})), (Indices{0, 1}));
  EXPECT_EQ(greedy_set_cover(instance_of(5, {{0}, {1, 2, 3}, {0, 4}})), (Indices{1, 2}));
}

// The greedy takes column 0 first; columns 1 and 2, which are needed for rows 4 and 5, then make it
// superfluous.
TEST(SetCover, DropsAColumnThatLaterOnesMadeSuperfluous) {
  EXPECT_EQ(greedy_set_cover(instance_of(6, {{0, 1, 2, 3}, {0, 1, 4}, {2, 3, 5}})),
            (Indices{1, 2}));
}

TEST(SetCover, RowsThatNoColumnCoversStayOpen) {
  EXPECT_EQ(greedy_set_cover(instance_of(3, {{1}})), (Indices{0}));
  EXPECT_EQ(greedy_set_cover(instance_of(3, {{}, {}})), Indices{});
  EXPECT_EQ(greedy_set_cover(instance_of(3, {})), Indices{});
  EXPECT_EQ(greedy_set_cover(instance_of(0, {{}})), Indices{});
}

}  // namespace
}  // namespace spherule::test
