// SPDX-License-Identifier: BSD-3-Clause
// Set cover: the greedy algorithm against its definition and against every subset, and the searches
// from there.
#include "simplifier/simplify.h"
#include "simplifier/stage2/search/cover_search.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
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
using internal::Tournament;

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

Indices all_columns(const SetCoverInstance& instance) {
  Indices all(instance.columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
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

TEST(SetCover, OfSmallInstancesIsKnown) {
  struct Case {
    SetCoverInstance instance;
    Indices expected;
  };
  for (const auto& [instance, expected] : std::vector<Case>{
           // The largest first, and the lowest index of equal ones.
           {{4, {{0, 1}, {2, 3}, {2, 3}, {0, 1}}}, {0, 1}},
           {{5, {{0}, {1, 2, 3}, {0, 4}}}, {1, 2}},
           // Column 0 comes first; columns 1 and 2, which are needed for rows 4 and 5, then make it
           // superfluous.
           {{6, {{0, 1, 2, 3}, {0, 1, 4}, {2, 3, 5}}}, {1, 2}},
           // Rows that no column covers stay open.
           {{3, {{1}}}, {0}},
           {{3, {{}, {}}}, {}},
           {{3, {}}, {}},
           {{0, {{}}}, {}}}) {
    EXPECT_EQ(greedy_set_cover(instance), expected);
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

// Against the instance itself: who holds what, and that nothing heavier was passed over.
TEST(CoverCore, HoldsTheHeaviestColumnsOfEachRow) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    // So that some rows have more columns than enter the core unseen, and others have not.
    const Planted made = planted(random, 200, 15, 1000);
    CoverSearch::Rows known;
    for (std::uint32_t row = 0; row < 200; row += 4) {
      known.rows.push_back(row);
      known.weights.push_back(1 + static_cast<std::uint32_t>(random.index(50)));
    }
    const std::vector<std::size_t> start{7, 3};
    internal::CoverCore core(made.instance, made.columns_of, known, start);
    std::vector<std::uint32_t> rows = known.rows;
    for (const std::uint32_t row : {1U, 2U}) {
      core.add_row(row);
      rows.push_back(row);
    }
    EXPECT_EQ(core.in_core(start), (std::vector<std::size_t>{0, 1}));
    EXPECT_LT(core.column_count(), made.instance.columns.size());
    std::vector<std::uint32_t> numbers(core.column_count());
    std::iota(numbers.begin(), numbers.end(), 0U);
    const std::vector<std::size_t> columns = core.in_instance(numbers);
    std::vector<std::uint64_t> weight(made.instance.columns.size(), 0);
    for (std::size_t k = 0; k < known.rows.size(); ++k) {
      for (const std::uint32_t c : made.columns_of[known.rows[k]]) weight[c] += known.weights[k];
    }
    std::uint64_t entries = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      std::set<std::size_t> listed;
      for (const std::uint32_t c : core.columns_of()[k]) EXPECT_TRUE(listed.insert(c).second);
      std::vector<std::uint64_t> in, out;
      for (const std::uint32_t c : made.columns_of[rows[k]]) {
        const auto at = std::ranges::find(columns, c);
        const bool held = at != columns.end();
        EXPECT_EQ(held, held && listed.contains(static_cast<std::size_t>(at - columns.begin())));
        (held ? in : out).push_back(weight[c]);
      }
      EXPECT_EQ(in.size(), listed.size());
      entries += in.size();
      std::ranges::sort(in, std::greater<>());
      if (!out.empty()) {
        ASSERT_GE(in.size(), 16U);
        EXPECT_GE(in[15], *std::ranges::max_element(out));
      }
    }
    EXPECT_EQ(core.entries(), entries);
  }
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

// --- tournament ---

// By a look at all of them.
std::uint32_t least_of(const std::vector<std::uint64_t>& keys, std::uint32_t except) {
  std::uint32_t best = Tournament::kNone;
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    if (i != except && (best == Tournament::kNone || keys[i] < keys[best])) best = i;
  }
  return best;
}

// Items come at the end, go with the last taking their place, and change, several between two
// questions; few keys make many ties.
TEST(Tournament, FindsWhatALookAtAllFinds) {
  Random random(1);
  for (const std::size_t most : {1U, 3U, 64U, 65U, 1000U}) {
    std::vector<std::uint64_t> keys;
    Tournament tournament;
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
      EXPECT_LT(a, keys.size());
      EXPECT_LT(b, keys.size());
      return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    };
    bool was_full = false;
    for (int question = 0; question < 2000; ++question) {
      was_full = was_full || keys.size() == most;
      for (std::size_t change = random.index(12); change > 0; --change) {
        const std::size_t what = random.index(4);
        if ((what == 0 || (what == 2 && !was_full)) && keys.size() < most) {
          keys.push_back(random.index(50));
          tournament.touch(static_cast<std::uint32_t>(keys.size() - 1));
        } else if (what == 1 && !keys.empty()) {
          const std::size_t gone = random.index(keys.size());
          keys[gone] = keys.back();
          keys.pop_back();
          tournament.touch(static_cast<std::uint32_t>(gone));
          tournament.touch(static_cast<std::uint32_t>(keys.size()));
        } else if (!keys.empty()) {
          const std::size_t changed = random.index(keys.size());
          keys[changed] = random.index(50);
          tournament.touch(static_cast<std::uint32_t>(changed));
        }
      }
      const std::uint32_t except = random.index(3) == 0 || keys.empty()
                                       ? Tournament::kNone
                                       : static_cast<std::uint32_t>(random.index(keys.size()));
      ASSERT_EQ(tournament.least(static_cast<std::uint32_t>(keys.size()), except, less),
                least_of(keys, except));
    }
    EXPECT_TRUE(was_full);
  }
}

}  // namespace
}  // namespace spherule::test
