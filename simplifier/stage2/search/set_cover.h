// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// Unicost set cover: rows 0 .. row_count - 1 are to be covered by few of the columns, each a set of
// rows. Knows no geometry.
struct SetCoverInstance {
  std::size_t row_count = 0;
  std::vector<std::vector<std::uint32_t>> columns;  // rows are distinct within a column
};

// A cover by lazy greedy (Minoux 1978): the column that covers most of the rows still open is taken
// again and again, ties to the lowest index, so its size is within 1 + ln(largest column) of the
// least; then columns that are no longer needed are dropped, the last taken first. Rows that no
// column covers stay open. Returns column indices in the order they were taken. Deterministic.
std::vector<std::size_t> greedy_set_cover(const SetCoverInstance& instance);

// How many of the columns cover each row.
std::vector<std::uint32_t> times_covered(const SetCoverInstance& instance,
                                         const std::vector<std::size_t>& columns);

// The rows that none of the columns covers, in order.
std::vector<std::uint32_t> open_rows(const SetCoverInstance& instance,
                                     const std::vector<std::size_t>& columns);

}  // namespace spherule::internal
