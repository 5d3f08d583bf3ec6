// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/lazy_cover_search.h"

#include "simplifier/stage2/search/cover_core.h"

#include <algorithm>
#include <numeric>

namespace spherule::internal {
namespace {

// Of the rows known, how many more are learned at once, and at least.
constexpr std::size_t kShare = 20;
constexpr std::size_t kLeast = 100;
// Between the seeds of a search's passes; those of different searches follow one another.
constexpr std::uint64_t kSeedStep = 0x9e3779b97f4a7c15;

}  // namespace

bool LazyCoverSearch::reach(std::size_t target, std::uint64_t visits, std::uint64_t seed,
                            const std::atomic<bool>& unneeded) {
  CoverCore core(instance_, columns_of_, known_, columns_);
  const std::uint64_t work = visits * core.entries();
  for (std::uint64_t done = 0;; seed += kSeedStep) {
    CoverSearch::Rows rows{{}, known_.weights};
    rows.rows.resize(known_.rows.size());
    std::iota(rows.rows.begin(), rows.rows.end(), std::uint32_t{0});
    CoverSearch search(core.column_count(), core.columns_of(), rows, core.in_core(columns_));
    const bool covers = search.reach(target, work - done, seed, unneeded);
    columns_ = core.in_instance(search.best_columns());
    known_.weights = search.weights();
    done += search.work();
    if (!covers) return false;
    const std::vector<std::uint32_t> open = open_rows(instance_, columns_);
    if (open.empty()) return true;
    if (done >= work || unneeded) return false;
    const std::size_t count = std::min(open.size(), known_.rows.size() / kShare + kLeast);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t row = open[i * open.size() / count];
      known_.add(row);
      core.add_row(row);
    }
  }
}

}  // namespace spherule::internal
