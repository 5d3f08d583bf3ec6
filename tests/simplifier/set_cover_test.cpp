// SPDX-License-Identifier: BSD-3-Clause
// Set cover: the greedy algorithm against its definition, and the searches from there.
#include "simplifier/simplify.h"
#include "simplifier/stage2/search/cover_search.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

namespace spherule::test {
namespace {

using internal::CoverSearch;
using internal::greedy_set_cover;
using internal::LazyCoverSearch;
using internal::SetCoverInstance;

using Indices = std::vector<std::size_t>;

SetCoverInstance random_instance(Random& random, std::size_t rows, std::size_t columns,
                                 double density) {
  std::vector<std::vector<std::uint32_t>> sets(columns);
  for (std::vector<std::uint32_t>& set : sets) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      if (random.unit() < density) set.push_back(row);
    }
  }
  return {rows, sets};
}

std::set<std::uint32_t> rows_of(const SetCoverInstance& instance, const Indices& chosen) {
  std::set<std::uint32_t> rows;
  for (const std::size_t c : chosen) {
    const auto& column = instance.columns[c];
    rows.insert(column.begin(), column.end());
  }
  return rows;
}

bool is_redundant(const SetCoverInstance& instance, const Indices& chosen, std::size_t which) {
  Indices others = chosen;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
  return rows_of(instance, others) == rows_of(instance, chosen);
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

// --- cover search ---

const std::atomic<bool> kNeeded{false};

using Rows = std::vector<std::uint32_t>;

struct Planted {
  SetCoverInstance instance;
  std::vector<Rows> columns_of;
  std::size_t known;  // columns that cover every row
};

// Rows dealt out to `known` columns, hidden among columns of the same size that hold random rows.
Planted planted(Random& random, std::size_t rows, std::size_t known, std::size_t others) {
  Planted made;
  made.known = known;
  made.instance.row_count = rows;
  std::vector<Rows> columns(known + others);
  for (std::uint32_t row = 0; row < rows; ++row) columns[random.index(known)].push_back(row);
  for (std::size_t c = known; c < columns.size(); ++c) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      if (random.index(known) == 0) columns[c].push_back(row);
    }
  }
  for (std::size_t c = columns.size() - 1; c > 0; --c) {
    std::swap(columns[c], columns[random.index(c + 1)]);
  }
  made.instance.columns = columns;
  made.columns_of.resize(rows);
  for (std::uint32_t c = 0; c < columns.size(); ++c) {
    for (const std::uint32_t row : columns[c]) made.columns_of[row].push_back(c);
  }
  return made;
}

bool covers_all(const SetCoverInstance& instance, const std::vector<std::uint32_t>& chosen) {
  std::vector<char> covered(instance.row_count, 0);
  for (const std::uint32_t c : chosen) {
    for (const std::uint32_t row : instance.columns[c]) covered[row] = 1;
  }
  return std::ranges::all_of(covered, [](char c) { return c != 0; });
}

CoverSearch::Rows rows_of(const SetCoverInstance& instance, std::size_t step = 1) {
  CoverSearch::Rows rows;
  for (std::size_t row = 0; row < instance.row_count; row += step) rows.add(row);
  return rows;
}

CoverSearch search_over(const SetCoverInstance& instance, const std::vector<Rows>& columns_of,
                        const std::vector<std::size_t>& start) {
  return {instance.columns.size(), columns_of, rows_of(instance), start};
}

std::vector<std::uint32_t> narrowed(const std::vector<std::size_t>& columns) {
  return {columns.begin(), columns.end()};
}

TEST(CoverSearch, FindsPlantedCoversThatGreedyMisses) {
  Random random(1);
  std::size_t greedy_sum = 0;
  std::size_t known_sum = 0;
  for (int i = 0; i < 20; ++i) {
    const Planted made = planted(random, 200, 10 + random.index(10), 200);
    const std::vector<std::size_t> greedy = greedy_set_cover(made.instance);
    greedy_sum += greedy.size();
    known_sum += made.known;
    CoverSearch search = search_over(made.instance, made.columns_of, greedy);
    EXPECT_TRUE(search.reach(made.known, 200'000'000, 5, kNeeded));
    EXPECT_LE(search.best_columns().size(), made.known);
    EXPECT_TRUE(covers_all(made.instance, search.best_columns()));
  }
  EXPECT_GT(greedy_sum, known_sum);
}

// Rows that no two columns share need as many columns as there are rows.
TEST(CoverSearch, SaysSoWhereThereIsNoCover) {
  SetCoverInstance instance;
  instance.row_count = 12;
  std::vector<Rows> columns_of(12);
  for (std::uint32_t row = 0; row < 12; ++row) {
    for (int copy = 0; copy < 3; ++copy) {
      columns_of[row].push_back(static_cast<std::uint32_t>(instance.columns.size()));
      instance.columns.push_back({row});
    }
  }
  CoverSearch search = search_over(instance, columns_of, greedy_set_cover(instance));
  EXPECT_FALSE(search.reach(11, 100'000, 1, kNeeded));
  EXPECT_EQ(search.best_columns().size(), 11U);
  CoverSearch enough = search_over(instance, columns_of, {});
  EXPECT_TRUE(enough.reach(12, 100'000, 1, kNeeded));
  EXPECT_TRUE(covers_all(instance, enough.best_columns()));
}

TEST(CoverSearch, IsEqualForEqualSeeds) {
  Random random(2);
  const Planted made = planted(random, 300, 20, 400);
  const auto run = [&](std::uint64_t seed) {
    CoverSearch search =
        search_over(made.instance, made.columns_of, greedy_set_cover(made.instance));
    search.reach(made.known + 2, 300'000, seed, kNeeded);
    return search.best_columns();
  };
  EXPECT_EQ(run(3), run(3));
  EXPECT_NE(run(3), run(4));
}

TEST(CoverSearch, NothingToCoverIsCovered) {
  const SetCoverInstance instance;
  const std::vector<Rows> columns_of;
  CoverSearch search = search_over(instance, columns_of, {});
  EXPECT_TRUE(search.reach(0, 0, 1, kNeeded));
  EXPECT_TRUE(search.best_columns().empty());
}

// Rows that are not requested may stay open; weights are those given, and grow.
TEST(CoverSearch, KnowsOnlyItsRowsAndTheirWeights) {
  SetCoverInstance instance{3, {{0}, {1}, {2}}};
  const std::vector<Rows> columns_of = {{0}, {1}, {2}};
  CoverSearch search(3, columns_of, {{0, 2}, {1, 9}}, std::vector<std::size_t>{0});
  EXPECT_FALSE(search.reach(1, 10, 1, kNeeded));
  EXPECT_TRUE(search.reach(2, 1000, 1, kNeeded));
  EXPECT_EQ(search.best_columns().size(), 2U);
  EXPECT_GE(search.weights().back(), 9U);
}

// Rounds that a search with these counts makes before it ends.
int rounds_that_pay(int effort, const std::function<std::size_t(int)>& count) {
  internal::CoverYield yield(effort, CoverOptions{}.effort);
  yield.add(count(0));
  for (int round = 1; round < 1000; ++round) {
    yield.add(count(round));
    if (!yield.pays()) return round;
  }
  return 1000;
}

TEST(CoverYield, EndsWhereATenthMoreTimeWouldSaveLessThanOnePerCent) {
  const auto steady = [](double saved) {
    return [saved](int round) { return static_cast<std::size_t>(1e6 * std::pow(saved, round)); };
  };
  // After 20 rounds, the first rate known, three more are a tenth of the time (the first answer
  // takes ten): 1 % each pays, 0.3 % each does not.
  EXPECT_EQ(rounds_that_pay(60, steady(0.99)), 1000);
  EXPECT_EQ(rounds_that_pay(60, steady(0.997)), 20);
  // What there is to save halves every ten rounds. In rounds 49 to 72 that is 2^-4.8 - 2^-7.2 =
  // 2.91 % of half a million, and 8.2 rounds are a tenth: 4,971 of 503,400, just below 1 %.
  const auto halving = [](int round) {
    return static_cast<std::size_t>(5e5 * (1.0 + std::pow(0.5, round / 10.0)));
  };
  EXPECT_EQ(rounds_that_pay(60, halving), 72);
  EXPECT_EQ(rounds_that_pay(30, halving), 72);
  EXPECT_GT(rounds_that_pay(120, halving), 72);
  // One of few spheres is worth waiting for, one of a hundred is not, but where time alone counts.
  const auto constant = [](std::size_t count) { return [count](int) { return count; }; };
  EXPECT_GT(rounds_that_pay(60, constant(4)), 100);
  EXPECT_EQ(rounds_that_pay(60, constant(100)), 20);
  EXPECT_EQ(rounds_that_pay(std::numeric_limits<int>::max(), constant(100)), 1000);
}

TEST(LazyCoverSearch, CoversAllRowsThoughItBeginsWithFew) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Planted made = planted(random, 400, 10 + random.index(10), 200);
    LazyCoverSearch search{made.instance, made.columns_of, rows_of(made.instance, 40),
                           greedy_set_cover(made.instance)};
    EXPECT_TRUE(search.reach(made.known, 100'000, 5, kNeeded));
    EXPECT_LE(search.columns().size(), made.known);
    EXPECT_TRUE(covers_all(made.instance, narrowed(search.columns())));
    EXPECT_EQ(search.known().rows.size(), search.known().weights.size());
    const std::set<std::uint32_t> distinct(search.known().rows.begin(), search.known().rows.end());
    EXPECT_EQ(distinct.size(), search.known().rows.size());
  }
}

TEST(LazyCoverSearch, SaysSoWhereItsBudgetEndsBeforeAllRowsAreCovered) {
  Random random(4);
  const Planted made = planted(random, 400, 20, 200);
  LazyCoverSearch search{made.instance, made.columns_of, rows_of(made.instance, 40), {}};
  EXPECT_FALSE(search.reach(made.known - 8, 20, 5, kNeeded));
  EXPECT_LE(search.columns().size(), made.known - 8);
}

}  // namespace
}  // namespace spherule::test
