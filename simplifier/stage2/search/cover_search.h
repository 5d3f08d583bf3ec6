// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/stage2/search/set_cover.h"
#include "simplifier/stage2/search/tournament.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Row-weighting local search for unicost set cover (Gao, Weise and Li, "An efficient local search
// heuristic with row weighting for the unicost set covering problem", EJOR 246, 2015): a column
// that would be missed least leaves, the best column for some open row enters, and rows weigh more
// the longer they stay open. Departure: a column that left may return once a row of it has opened
// or closed, and not after any change at any neighbour, which would cost more to follow.
// Deterministic.
class CoverSearch {
 public:
  // Some of the rows of an instance, with what they weigh at the start, at least 1.
  struct Rows {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> weights;

    void add(std::size_t row) {
      rows.push_back(static_cast<std::uint32_t>(row));
      weights.push_back(1);
    }
  };

  // Starts from the columns `start`, of `column_count` in all. `columns_of` lists the columns that
  // hold each row of the instance, one at least for those that are to be covered.
  CoverSearch(std::size_t column_count, std::span<const std::vector<std::uint32_t>> columns_of,
              const Rows& rows, std::span<const std::size_t> start);

  // Drops columns until at most `target` are left, then exchanges columns until every row is
  // covered, about `work` entries of the instance have been visited, or `unneeded` is set from
  // outside. True if every row is covered.
  bool reach(std::size_t target, std::uint64_t work, std::uint64_t seed,
             const std::atomic<bool>& unneeded);

  // The columns chosen when the fewest rows were open, ties to the first.
  const std::vector<std::uint32_t>& best_columns() const { return best_columns_; }
  // What the rows weigh now, in the order in which they were given.
  std::vector<std::uint32_t> weights() const;
  std::uint64_t work() const { return work_; }

 private:
  // A set of small numbers with a fixed order that depends on the calls alone.
  class IndexSet {
   public:
    explicit IndexSet(std::size_t universe) : position_(universe, kAbsent) {}
    void insert(std::uint32_t i);
    void erase(std::uint32_t i);
    // kAbsent for what is not in the set.
    std::uint32_t position(std::uint32_t i) const { return position_[i]; }
    std::span<const std::uint32_t> items() const { return items_; }

    static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

   private:
    std::vector<std::uint32_t> items_;
    std::vector<std::uint32_t> position_;
  };

  void add(std::uint32_t column);
  void remove(std::uint32_t column);
  std::uint32_t least_missed();
  std::uint32_t best_for(std::uint32_t row) const;
  void weigh_open_rows();

  // For each of several items a list of numbers, one after the other.
  class Lists {
   public:
    explicit Lists(std::vector<std::uint32_t> sizes);
    void append(std::uint32_t item, std::uint32_t number) { numbers_[end_[item]++] = number; }
    std::span<const std::uint32_t> operator[](std::uint32_t item) const {
      return {numbers_.data() + begin_[item], end_[item] - begin_[item]};
    }

   private:
    std::vector<std::uint64_t> begin_;
    std::vector<std::uint64_t> end_;
    std::vector<std::uint32_t> numbers_;
  };
  static Lists lists_of(std::span<const std::vector<std::uint32_t>> columns_of, const Rows& rows);
  static Lists transposed(std::size_t column_count, const Lists& columns_of, std::size_t row_count);

  Lists columns_of_;
  Lists rows_of_;
  struct Row {
    std::uint32_t weight = 1;
    std::uint32_t times = 0;       // how many chosen columns cover it
    std::uint32_t covered_by = 0;  // sum of their numbers, modulo 2^32: names a single one
  };
  std::vector<Row> row_;
  // Of a column: the weight of the rows that it alone covers, or would newly cover.
  std::vector<std::int64_t> score_;
  std::vector<std::uint64_t> moved_at_;
  std::vector<char> may_enter_;
  IndexSet chosen_;
  Tournament by_loss_;  // of the positions in `chosen_`
  IndexSet open_;
  std::vector<std::uint32_t> best_columns_;
  std::uint32_t entered_last_;
  std::uint64_t clock_ = 0;
  std::uint64_t work_ = 0;  // visits so far
};

}  // namespace spherule::internal
