// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/cover_search.h"

#include "simplifier/support/random.h"

#include <cassert>
#include <limits>
#include <numeric>
#include <utility>

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

CoverSearch::Lists::Lists(std::vector<std::uint32_t> sizes) : begin_(sizes.size()) {
  std::exclusive_scan(sizes.begin(), sizes.end(), begin_.begin(), std::uint64_t{0});
  end_ = begin_;
  numbers_.resize(sizes.empty() ? 0 : begin_.back() + sizes.back());
}

CoverSearch::Lists CoverSearch::lists_of(std::span<const std::vector<std::uint32_t>> columns_of,
                                         const Rows& rows) {
  std::vector<std::uint32_t> sizes;
  for (const std::uint32_t row : rows.rows) {
    sizes.push_back(static_cast<std::uint32_t>(columns_of[row].size()));
  }
  Lists lists(std::move(sizes));
  for (std::uint32_t i = 0; i < rows.rows.size(); ++i) {
    for (const std::uint32_t column : columns_of[rows.rows[i]]) lists.append(i, column);
  }
  return lists;
}

CoverSearch::Lists CoverSearch::transposed(std::size_t column_count, const Lists& columns_of,
                                           std::size_t row_count) {
  std::vector<std::uint32_t> sizes(column_count, 0);
  for (std::uint32_t row = 0; row < row_count; ++row) {
    for (const std::uint32_t column : columns_of[row]) ++sizes[column];
  }
  Lists lists(std::move(sizes));
  for (std::uint32_t row = 0; row < row_count; ++row) {
    for (const std::uint32_t column : columns_of[row]) lists.append(column, row);
  }
  return lists;
}

CoverSearch::CoverSearch(std::size_t column_count,
                         std::span<const std::vector<std::uint32_t>> columns_of, const Rows& rows,
                         std::span<const std::size_t> start)
    : columns_of_(lists_of(columns_of, rows)),
      rows_of_(transposed(column_count, columns_of_, rows.rows.size())),
      row_(rows.rows.size()),
      score_(column_count, 0),
      moved_at_(column_count, 0),
      may_enter_(column_count, 1),
      chosen_(column_count),
      open_(rows.rows.size()),
      entered_last_(std::numeric_limits<std::uint32_t>::max()) {
  for (std::uint32_t r = 0; r < row_.size(); ++r) {
    assert(!columns_of_[r].empty());
    row_[r].weight = rows.weights[r];
    open_.insert(r);
    for (const std::uint32_t c : columns_of_[r]) score_[c] += row_[r].weight;
  }
  for (const std::size_t c : start) add(static_cast<std::uint32_t>(c));
}

std::vector<std::uint32_t> CoverSearch::weights() const {
  std::vector<std::uint32_t> weights;
  for (const Row& row : row_) weights.push_back(row.weight);
  return weights;
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
      by_loss_.touch(chosen_.position(row.covered_by));
    }
    ++row.times;
    row.covered_by += column;
  }
  moved_at_[column] = clock_;
  chosen_.insert(column);
  by_loss_.touch(chosen_.position(column));
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
      by_loss_.touch(chosen_.position(row.covered_by));
    }
  }
  moved_at_[column] = clock_;
  may_enter_[column] = 0;
  by_loss_.touch(chosen_.position(column));  // the last takes it
  chosen_.erase(column);
  by_loss_.touch(static_cast<std::uint32_t>(chosen_.items().size()));
}

std::uint32_t CoverSearch::least_missed() {
  const std::span<const std::uint32_t> chosen = chosen_.items();
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t first = chosen[a], second = chosen[b];
    if (score_[first] != score_[second]) return score_[first] < score_[second];
    if (moved_at_[first] != moved_at_[second]) return moved_at_[first] < moved_at_[second];
    return a < b;
  };
  const bool has_last = entered_last_ < score_.size();
  const std::uint32_t position =
      by_loss_.least(static_cast<std::uint32_t>(chosen.size()),
                     has_last ? chosen_.position(entered_last_) : IndexSet::kAbsent, less);
  return position == Tournament::kNone ? chosen.front() : chosen[position];
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
