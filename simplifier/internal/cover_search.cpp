// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/cover_search.h"

#include "simplifier/internal/random.h"

#include <limits>

namespace spherule::internal {

void CoverSearch::IndexSet::insert(std::uint32_t i) {
  position_[i] = static_cast<std::uint32_t>(items_.size());
  items_.push_back(i);
}

void CoverSearch::IndexSet::erase(std::uint32_t i) {
  const std::uint32_t last = items_.back();
  items_[position_[i]] = last;
  position_[last] = position_[i];
  items_.pop_back();
  position_[i] = kAbsent;
}

CoverSearch::CoverSearch(const SetCoverInstance& instance,
                         const std::vector<std::vector<std::uint32_t>>& columns_of,
                         std::span<const std::size_t> start)
    : rows_of_(instance.columns),
      columns_of_(columns_of),
      row_(instance.row_count),
      score_(instance.columns.size()),
      moved_at_(instance.columns.size(), 0),
      may_enter_(instance.columns.size(), 1),
      chosen_(instance.columns.size()),
      open_(instance.row_count),
      entered_last_(std::numeric_limits<std::uint32_t>::max()) {
  for (std::size_t c = 0; c < instance.columns.size(); ++c) {
    score_[c] = static_cast<std::int64_t>(instance.columns[c].size());
  }
  for (std::size_t r = 0; r < instance.row_count; ++r) {
    open_.insert(static_cast<std::uint32_t>(r));
  }
  for (const std::size_t c : start) add(static_cast<std::uint32_t>(c));
}

void CoverSearch::add(std::uint32_t column) {
  work_ += rows_of_[column].size();
  for (const std::uint32_t r : rows_of_[column]) {
    Row& row = row_[r];
    if (row.times == 0) {
      open_.erase(r);
      work_ += columns_of_[r].size();
      for (const std::uint32_t c : columns_of_[r]) {
        score_[c] -= row.weight;
        may_enter_[c] = 1;
      }
      score_[column] += row.weight;
    } else if (row.times == 1) {
      score_[row.covered_by] -= row.weight;
    }
    ++row.times;
    row.covered_by += column;
  }
  moved_at_[column] = clock_;
  chosen_.insert(column);
}

void CoverSearch::remove(std::uint32_t column) {
  work_ += rows_of_[column].size();
  for (const std::uint32_t r : rows_of_[column]) {
    Row& row = row_[r];
    --row.times;
    row.covered_by -= column;
    if (row.times == 0) {
      open_.insert(r);
      work_ += columns_of_[r].size();
      for (const std::uint32_t c : columns_of_[r]) {
        score_[c] += row.weight;
        may_enter_[c] = 1;
      }
      score_[column] -= row.weight;
    } else if (row.times == 1) {
      score_[row.covered_by] += row.weight;
    }
  }
  moved_at_[column] = clock_;
  may_enter_[column] = 0;
  chosen_.erase(column);
}

std::uint32_t CoverSearch::least_missed() const {
  std::uint32_t best = chosen_.items().front();
  bool found = false;
  for (const std::uint32_t c : chosen_.items()) {
    if (c == entered_last_) continue;
    if (!found || score_[c] < score_[best] ||
        (score_[c] == score_[best] && moved_at_[c] < moved_at_[best])) {
      best = c;
      found = true;
    }
  }
  return best;
}

std::uint32_t CoverSearch::best_for(std::uint32_t row) const {
  const auto better = [&](std::uint32_t a, std::uint32_t b) {
    if (may_enter_[a] != may_enter_[b]) return may_enter_[a] > may_enter_[b];
    return score_[a] > score_[b] || (score_[a] == score_[b] && moved_at_[a] < moved_at_[b]);
  };
  std::uint32_t best = columns_of_[row].front();
  for (const std::uint32_t c : columns_of_[row]) {
    if (better(c, best)) best = c;
  }
  return best;
}

void CoverSearch::weigh_open_rows() {
  for (const std::uint32_t row : open_.items()) {
    ++row_[row].weight;
    work_ += columns_of_[row].size();
    for (const std::uint32_t c : columns_of_[row]) ++score_[c];
  }
}

bool CoverSearch::reach(std::size_t target, std::uint64_t work, std::uint64_t seed,
                        const std::atomic<bool>& unneeded) {
  while (chosen_.items().size() > target) remove(least_missed());
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  Random random(seed);
  work_ = 0;
  for (;;) {
    const std::span<const std::uint32_t> open = open_.items();
    if (open.size() < fewest) {
      fewest = open.size();
      best_columns_.assign(chosen_.items().begin(), chosen_.items().end());
    }
    if (open.empty() || work_ >= work || unneeded) return open.empty();
    ++clock_;
    if (chosen_.items().size() >= target && !chosen_.items().empty()) remove(least_missed());
    entered_last_ = best_for(open_.items()[random.index(open_.items().size())]);
    add(entered_last_);
    weigh_open_rows();
  }
}

}  // namespace spherule::internal
