// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/stage2/search/cover_search.h"
#include "simplifier/stage2/search/set_cover.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The part of a set cover instance that a local search works on: of each row that it knows, the few
// columns that hold the most weight of known rows (all, where they are few anyway), and the columns
// it starts from (the core problem
// of Caprara, Fischetti and Toth, "A heuristic method for the set covering problem", Operations
// Research 47, 1999, who price columns by Lagrangian costs; the weights of the rows stand for the
// multipliers here). Where a row is held by thousands of columns, a search over all of them spends
// its time on columns that never enter. Rows and columns have numbers of their own.
class CoverCore {
 public:
  // Refers to the instance and its lists.
  CoverCore(const SetCoverInstance& instance,
            const std::vector<std::vector<std::uint32_t>>& columns_of,
            const CoverSearch::Rows& known, std::span<const std::size_t> start);

  // Another row, with its best columns.
  void add_row(std::uint32_t row);

  std::size_t column_count() const { return columns_.size(); }
  // For each row, in the order in which they came, its columns in the core.
  std::span<const std::vector<std::uint32_t>> columns_of() const { return lists_; }
  // How many pairs of a row and a column that holds it there are.
  std::uint64_t entries() const { return entries_; }

  // Between numbers of the core and of the instance.
  std::vector<std::size_t> in_core(std::span<const std::size_t> columns) const;
  std::vector<std::size_t> in_instance(std::span<const std::uint32_t> columns) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::vector<std::uint32_t>& add_list(std::uint32_t row);
  void add_best_columns(std::uint32_t row);
  void add_column(std::uint32_t column);

  const SetCoverInstance& instance_;
  const std::vector<std::vector<std::uint32_t>>& columns_of_;
  std::vector<std::uint64_t> weight_;         // of each column of the instance
  std::vector<std::uint32_t> column_number_;  // in the core, or kNone
  std::vector<std::uint32_t> row_number_;
  std::vector<std::uint32_t> columns_;  // their numbers in the instance
  std::vector<std::vector<std::uint32_t>> lists_;
  std::uint64_t entries_ = 0;
};

}  // namespace spherule::internal
