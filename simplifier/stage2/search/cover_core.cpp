// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/cover_core.h"

#include <algorithm>
#include <array>

namespace spherule::internal {
namespace {

// Columns of each row that enter the core: all where they are few, as in plates, where none is to
// spare; else the heaviest.
constexpr std::size_t kFew = 64;
constexpr std::size_t kBest = 16;

}  // namespace

CoverCore::CoverCore(const SetCoverInstance& instance,
                     const std::vector<std::vector<std::uint32_t>>& columns_of,
                     const CoverSearch::Rows& known, std::span<const std::size_t> start)
    : instance_(instance),
      columns_of_(columns_of),
      weight_(instance.columns.size(), 0),
      column_number_(instance.columns.size(), kNone),
      row_number_(instance.row_count, kNone) {
  for (std::size_t i = 0; i < known.rows.size(); ++i) {
    for (const std::uint32_t c : columns_of[known.rows[i]]) weight_[c] += known.weights[i];
  }
  for (const std::uint32_t row : known.rows) add_list(row);
  for (const std::size_t c : start) add_column(static_cast<std::uint32_t>(c));
  for (const std::uint32_t row : known.rows) add_best_columns(row);
}

void CoverCore::add_row(std::uint32_t row) {
  std::vector<std::uint32_t>& list = add_list(row);
  for (const std::uint32_t c : columns_of_[row]) {
    if (column_number_[c] != kNone) list.push_back(column_number_[c]);
  }
  entries_ += list.size();
  add_best_columns(row);
}

std::vector<std::uint32_t>& CoverCore::add_list(std::uint32_t row) {
  row_number_[row] = static_cast<std::uint32_t>(lists_.size());
  std::vector<std::uint32_t>& list = lists_.emplace_back();
  list.reserve(std::min(columns_of_[row].size(), kFew));
  return list;
}

void CoverCore::add_best_columns(std::uint32_t row) {
  if (columns_of_[row].size() <= kFew) {
    for (const std::uint32_t c : columns_of_[row]) add_column(c);
    return;
  }
  std::array<std::uint32_t, kBest> best;
  std::size_t count = 0;
  for (const std::uint32_t c : columns_of_[row]) {
    if (count == kBest && weight_[c] <= weight_[best[count - 1]]) continue;
    std::size_t at = count < kBest ? count++ : count - 1;
    for (; at > 0 && weight_[best[at - 1]] < weight_[c]; --at) best[at] = best[at - 1];
    best[at] = c;
  }
  for (std::size_t i = 0; i < count; ++i) add_column(best[i]);
}

void CoverCore::add_column(std::uint32_t column) {
  if (column_number_[column] != kNone) return;
  column_number_[column] = static_cast<std::uint32_t>(columns_.size());
  columns_.push_back(column);
  for (const std::uint32_t row : instance_.columns[column]) {
    if (row_number_[row] == kNone) continue;
    lists_[row_number_[row]].push_back(column_number_[column]);
    ++entries_;
  }
}

std::vector<std::size_t> CoverCore::in_core(std::span<const std::size_t> columns) const {
  std::vector<std::size_t> numbers;
  for (const std::size_t c : columns) numbers.push_back(column_number_[c]);
  return numbers;
}

std::vector<std::size_t> CoverCore::in_instance(std::span<const std::uint32_t> columns) const {
  std::vector<std::size_t> numbers;
  for (const std::uint32_t c : columns) numbers.push_back(columns_[c]);
  return numbers;
}

}  // namespace spherule::internal
