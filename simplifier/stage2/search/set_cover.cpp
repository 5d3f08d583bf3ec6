// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/set_cover.h"

#include <algorithm>
#include <queue>

namespace spherule::internal {
namespace {

// Drops the columns whose rows are all covered by others that are kept.
std::vector<std::size_t> without_redundant(const SetCoverInstance& instance,
                                           std::vector<std::size_t> chosen) {
  std::vector<std::uint32_t> times = times_covered(instance, chosen);
  std::vector<std::size_t> kept;
  for (auto it = chosen.rbegin(); it != chosen.rend(); ++it) {
    const std::vector<std::uint32_t>& column = instance.columns[*it];
    if (std::ranges::all_of(column, [&](std::uint32_t row) { return times[row] > 1; })) {
      for (const std::uint32_t row : column) --times[row];
    } else {
      kept.push_back(*it);
    }
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

std::vector<std::size_t> greedy_set_cover(const SetCoverInstance& instance) {
  struct Offer {
    std::size_t gain;  // an upper bound: gains only shrink
    std::size_t column;
    bool operator<(const Offer& other) const {
      return gain < other.gain || (gain == other.gain && column > other.column);
    }
  };
  std::priority_queue<Offer> offers;
  for (std::size_t c = 0; c < instance.columns.size(); ++c) {
    offers.push({instance.columns[c].size(), c});
  }
  std::vector<bool> covered(instance.row_count, false);
  std::vector<std::size_t> chosen;
  while (!offers.empty()) {
    Offer best = offers.top();
    offers.pop();
    const std::vector<std::uint32_t>& column = instance.columns[best.column];
    const auto gain = static_cast<std::size_t>(
        std::ranges::count_if(column, [&](std::uint32_t row) { return !covered[row]; }));
    if (gain == 0) continue;
    if (gain < best.gain) {
      best.gain = gain;
      offers.push(best);
      continue;
    }
    chosen.push_back(best.column);
    for (const std::uint32_t row : column) covered[row] = true;
  }
  return without_redundant(instance, std::move(chosen));
}

std::vector<std::uint32_t> times_covered(const SetCoverInstance& instance,
                                         const std::vector<std::size_t>& columns) {
  std::vector<std::uint32_t> times(instance.row_count, 0);
  for (const std::size_t c : columns) {
    for (const std::uint32_t row : instance.columns[c]) ++times[row];
  }
  return times;
}

std::vector<std::uint32_t> open_rows(const SetCoverInstance& instance,
                                     const std::vector<std::size_t>& columns) {
  std::vector<char> covered(instance.row_count, 0);
  for (const std::size_t c : columns) {
    for (const std::uint32_t row : instance.columns[c]) covered[row] = 1;
  }
  std::vector<std::uint32_t> open;
  for (std::uint32_t row = 0; row < instance.row_count; ++row) {
    if (covered[row] == 0) open.push_back(row);
  }
  return open;
}

}  // namespace spherule::internal
