// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/lazy_cover_search.h"

#include <algorithm>

namespace spherule::internal {
namespace {

// Of the rows known, how many more are learned at once, and at least.
constexpr std::size_t kShare = 20;
constexpr std::size_t kLeast = 100;

}  // namespace

bool LazyCoverSearch::reach(std::size_t target, std::uint64_t work, std::uint64_t seed,
                            const std::atomic<bool>& unneeded) {
  for (std::uint64_t done = 0;; ++seed) {
    CoverSearch search(instance.columns.size(), columns_of, rows, columns);
    const bool covers = search.reach(target, work - done, seed, unneeded);
    columns.assign(search.best_columns().begin(), search.best_columns().end());
    rows.weights = search.weights();
    done += search.work();
    if (!covers) return false;
    const std::vector<std::uint32_t> open = open_rows(instance, columns);
    if (open.empty()) return true;
    if (done >= work || unneeded) return false;
    const std::size_t count = std::min(open.size(), rows.rows.size() / kShare + kLeast);
    for (std::size_t i = 0; i < count; ++i) rows.add(open[i * open.size() / count]);
  }
}

}  // namespace spherule::internal
