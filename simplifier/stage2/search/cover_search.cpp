// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/cover_search.h"

#include "base/random.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

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
