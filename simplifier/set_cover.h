// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// Unicost set cover: rows 0 .. row_count - 1 are to be covered by few of the columns, each a set of
// rows. Knows no geometry.
struct SetCoverInstance {
  std::size_t row_count = 0;
  std::vector<std::size_t> column_begin{0};  // column c holds rows[column_begin[c] .. [c + 1])
  std::vector<std::uint32_t> rows;           // distinct within a column

  std::size_t column_count() const { return column_begin.size() - 1; }
  std::span<const std::uint32_t> column(std::size_t c) const {
    return std::span(rows).subspan(column_begin[c], column_begin[c + 1] - column_begin[c]);
  }
  void add_column(std::span<const std::uint32_t> covered) {
    rows.insert(rows.end(), covered.begin(), covered.end());
    column_begin.push_back(rows.size());
  }
};

// A cover by lazy greedy (Minoux 1978): the column that covers most of the rows still open is taken
// again and again, ties to the lowest index, so its size is within 1 + ln(largest column) of the
// least; then columns that are no longer needed are dropped, the last taken first. Rows that no
// column covers stay open. Returns column indices in the order they were taken. Deterministic.
std::vector<std::size_t> greedy_set_cover(const SetCoverInstance& instance);

}  // namespace spherule
