// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/stage2/search/cover_search.h"
#include "simplifier/stage2/search/set_cover.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace spherule::internal {

// A cover search over the rows that matter: most rows are covered by whatever covers the others, so
// the search knows only some of them, and learns of rows that it has left open whenever it has
// covered those it knows (constraint generation).
class LazyCoverSearch {
 public:
  // Refers to the instance and its lists. `known` are the rows known from the start, `columns`
  // those to start from.
  LazyCoverSearch(const SetCoverInstance& instance,
                  const std::vector<std::vector<std::uint32_t>>& columns_of,
                  CoverSearch::Rows known, std::vector<std::size_t> columns)
      : instance_(instance),
        columns_of_(columns_of),
        known_(std::move(known)),
        columns_(std::move(columns)) {}

  // As CoverSearch::reach, on a CoverCore. All searches between which rows are learned make about
  // `visits` for each entry of the core that the first begins with.
  // True if every row of the instance is covered.
  bool reach(std::size_t target, std::uint64_t visits, std::uint64_t seed,
             const std::atomic<bool>& unneeded);

  // After reach(): the rows known by then, with their weights, and the best columns found.
  const CoverSearch::Rows& known() const { return known_; }
  const std::vector<std::size_t>& columns() const { return columns_; }

 private:
  const SetCoverInstance& instance_;
  const std::vector<std::vector<std::uint32_t>>& columns_of_;
  CoverSearch::Rows known_;
  std::vector<std::size_t> columns_;
};

}  // namespace spherule::internal
