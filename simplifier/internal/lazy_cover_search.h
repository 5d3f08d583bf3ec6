// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/internal/cover_search.h"
#include "simplifier/internal/set_cover.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// A cover search over the rows that matter: most rows are covered by whatever covers the others, so
// the search knows only some of them, and learns of rows that it has left open whenever it has
// covered those it knows (constraint generation).
struct LazyCoverSearch {
  const SetCoverInstance& instance;
  const std::vector<std::vector<std::uint32_t>>& columns_of;
  // Known from the start, and learned.
  CoverSearch::Rows rows;
  // Those to start from; the best found.
  std::vector<std::size_t> columns;

  // As CoverSearch::reach. True if every row of the instance is covered.
  bool reach(std::size_t target, std::uint64_t work, std::uint64_t seed,
             const std::atomic<bool>& unneeded);
};

}  // namespace spherule::internal
