// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
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

// The least item of a list whose items change a few at a time: a tournament tree over their
// positions. A change costs two comparisons on average, most items being beaten at once.
class Tournament {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // To be called for each position whose item has come, gone or changed since the last `least`.
  void touch(std::uint32_t position) {
    if (position >= leaves_) grow(position);
    if (is_touched_[position] != 0) return;
    is_touched_[position] = 1;
    touched_.push_back(position);
  }

  // The least position below `size` other than `except`, by `less`, a strict total order of the
  // positions below `size`; kNone if there is no other.
  template <class Less>
  std::uint32_t least(std::uint32_t size, std::uint32_t except, const Less& less) {
    for (const std::uint32_t position : touched_) {
      is_touched_[position] = 0;
      update(position, size, less);
    }
    touched_.clear();
    if (leaves_ == 0) return kNone;
    if (except >= size) return winner_[1];
    std::uint32_t best = kNone;
    for (std::size_t node = leaves_ + except; node > 1; node /= 2) {
      best = winner_of(best, winner_[node ^ 1], size, less);
    }
    return best;
  }

 private:
  // What is not below `size` is gone, or kNone.
  template <class Less>
  static std::uint32_t winner_of(std::uint32_t a, std::uint32_t b, std::uint32_t size,
                                 const Less& less) {
    if (a >= size) return b >= size ? kNone : b;
    return b >= size || less(a, b) ? a : b;
  }

  // Up to where another item still wins: what is above does not depend on this one, and another
  // winner that is touched has an update of its own.
  template <class Less>
  void update(std::uint32_t position, std::uint32_t size, const Less& less) {
    std::size_t node = leaves_ + position;
    winner_[node] = position < size ? position : kNone;
    for (node /= 2; node > 0; node /= 2) {
      const std::uint32_t winner = winner_of(winner_[2 * node], winner_[2 * node + 1], size, less);
      if (winner == winner_[node] && winner != position) return;
      winner_[node] = winner;
    }
  }

  void grow(std::uint32_t position) {
    const std::size_t before = leaves_;
    leaves_ = std::max<std::size_t>(64, before);
    while (leaves_ <= position) leaves_ *= 2;
    winner_.assign(2 * leaves_, kNone);
    is_touched_.resize(leaves_, 0);
    for (std::uint32_t p = 0; p < before; ++p) touch(p);
  }

  std::size_t leaves_ = 0;  // a power of two; those without an item come last
  // The root is at 1, the children of a node at 2 n and 2 n + 1.
  std::vector<std::uint32_t> winner_;
  std::vector<std::uint32_t> touched_;
  std::vector<char> is_touched_;
};

// Row-weighting local search for unicost set cover (Gao, Weise and Li, "An efficient local search
// heuristic with row weighting for the unicost set covering problem", EJOR 246, 2015): a column
// that would be missed least leaves, the best column for some open row enters, and rows weigh more
// the longer they stay open. Departure: a column that left may return once a row of it has opened
// or closed, and not after any change at any neighbour, which would cost more to follow.
// Deterministic.
class CoverSearch {
 public:
  // Some of the rows of an instance, with what they weigh at the start, at least 1.
  struct Rows {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> weights;

    void add(std::size_t row) {
      rows.push_back(static_cast<std::uint32_t>(row));
      weights.push_back(1);
    }
  };

  // Starts from the columns `start`, of `column_count` in all. `columns_of` lists the columns that
  // hold each row of the instance, one at least for those that are to be covered.
  CoverSearch(std::size_t column_count, std::span<const std::vector<std::uint32_t>> columns_of,
              const Rows& rows, std::span<const std::size_t> start);

  // Drops columns until at most `target` are left, then exchanges columns until every row is
  // covered, about `work` entries of the instance have been visited, or `unneeded` is set from
  // outside. True if every row is covered.
  bool reach(std::size_t target, std::uint64_t work, std::uint64_t seed,
             const std::atomic<bool>& unneeded);

  // The columns chosen when the fewest rows were open, ties to the first.
  const std::vector<std::uint32_t>& best_columns() const { return best_columns_; }
  // What the rows weigh now, in the order in which they were given.
  std::vector<std::uint32_t> weights() const;
  std::uint64_t work() const { return work_; }

 private:
  // A set of small numbers with a fixed order that depends on the calls alone.
  class IndexSet {
   public:
    explicit IndexSet(std::size_t universe) : position_(universe, kAbsent) {}
    void insert(std::uint32_t i);
    void erase(std::uint32_t i);
    // kAbsent for what is not in the set.
    std::uint32_t position(std::uint32_t i) const { return position_[i]; }
    std::span<const std::uint32_t> items() const { return items_; }

    static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

   private:
    std::vector<std::uint32_t> items_;
    std::vector<std::uint32_t> position_;
  };

  void add(std::uint32_t column);
  void remove(std::uint32_t column);
  std::uint32_t least_missed();
  std::uint32_t best_for(std::uint32_t row) const;
  void weigh_open_rows();

  // For each of several items a list of numbers, one after the other.
  class Lists {
   public:
    explicit Lists(std::vector<std::uint32_t> sizes);
    void append(std::uint32_t item, std::uint32_t number) { numbers_[end_[item]++] = number; }
    std::span<const std::uint32_t> operator[](std::uint32_t item) const {
      return {numbers_.data() + begin_[item], end_[item] - begin_[item]};
    }

   private:
    std::vector<std::uint64_t> begin_;
    std::vector<std::uint64_t> end_;
    std::vector<std::uint32_t> numbers_;
  };
  static Lists lists_of(std::span<const std::vector<std::uint32_t>> columns_of, const Rows& rows);
  static Lists transposed(std::size_t column_count, const Lists& columns_of, std::size_t row_count);

  Lists columns_of_;
  Lists rows_of_;
  struct Row {
    std::uint32_t weight = 1;
    std::uint32_t times = 0;       // how many chosen columns cover it
    std::uint32_t covered_by = 0;  // sum of their numbers, modulo 2^32: names a single one
  };
  std::vector<Row> row_;
  // Of a column: the weight of the rows that it alone covers, or would newly cover.
  std::vector<std::int64_t> score_;
  std::vector<std::uint64_t> moved_at_;
  std::vector<char> may_enter_;
  IndexSet chosen_;
  Tournament by_loss_;  // of the positions in `chosen_`
  IndexSet open_;
  std::vector<std::uint32_t> best_columns_;
  std::uint32_t entered_last_;
  std::uint64_t clock_ = 0;
  std::uint64_t work_ = 0;  // visits so far
};

// The part of a set cover instance that a local search works on: of each row that it knows, the few
// columns that hold the most weight of known rows (all, where they are few anyway), and the columns
// it starts from (the core problem
// of Caprara, Fischetti and Toth, "A heuristic method for the set covering problem", Operations
// Research 47, 1999, who price columns by Lagrangian costs; the weights of the rows stand for the
// multipliers here). Where a row is held by thousands of columns, a search over all of them spends
// its time on columns that never enter. Rows and columns have numbers of their own.
class CoverCore {
 public:
  // Refers to the instance and its lists.
  CoverCore(const SetCoverInstance& instance,
            const std::vector<std::vector<std::uint32_t>>& columns_of,
            const CoverSearch::Rows& known, std::span<const std::size_t> start);

  // Another row, with its best columns.
  void add_row(std::uint32_t row);

  std::size_t column_count() const { return columns_.size(); }
  // For each row, in the order in which they came, its columns in the core.
  std::span<const std::vector<std::uint32_t>> columns_of() const { return lists_; }
  // How many pairs of a row and a column that holds it there are.
  std::uint64_t entries() const { return entries_; }

  // Between numbers of the core and of the instance.
  std::vector<std::size_t> in_core(std::span<const std::size_t> columns) const;
  std::vector<std::size_t> in_instance(std::span<const std::uint32_t> columns) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::vector<std::uint32_t>& add_list(std::uint32_t row);
  void add_best_columns(std::uint32_t row);
  void add_column(std::uint32_t column);

  const SetCoverInstance& instance_;
  const std::vector<std::vector<std::uint32_t>>& columns_of_;
  std::vector<std::uint64_t> weight_;         // of each column of the instance
  std::vector<std::uint32_t> column_number_;  // in the core, or kNone
  std::vector<std::uint32_t> row_number_;
  std::vector<std::uint32_t> columns_;  // their numbers in the instance
  std::vector<std::vector<std::uint32_t>> lists_;
  std::uint64_t entries_ = 0;
};

// Whether another tenth of the time that a search has taken would pay: whether it may be expected
// to save 1 % of the spheres, or less in proportion where more effort than the default was
// requested. Time is counted in rounds, so that the answer does not depend on the machine.
class CoverYield {
 public:
  // The effort that is requested, and that of the default (CoverOptions::effort).
  CoverYield(int effort, int default_effort)
      : least_(kLeast * std::min(1.0, default_effort / static_cast<double>(effort))) {}

  // After the first answer and after each round, with the count proved by then.
  void add(std::size_t count) { counts_.push_back(count); }

  // From the rate at which the latest third of the rounds saved spheres. Half a sphere is added to
  // what they saved: of few spheres one is many per cent, and seldom found.
  bool pays() const {
    const std::size_t rounds = counts_.size() - 1;
    const std::size_t latest = std::max(kLatest, rounds / 3);
    if (rounds < latest) return true;
    const std::size_t count = counts_.back();
    const double saved = 0.5 + static_cast<double>(counts_[rounds - latest] - count);
    const double tenth = 0.1 * static_cast<double>(rounds + kFirstAnswer);
    return saved * tenth >= least_ * static_cast<double>(latest * count);
  }

 private:
  static constexpr double kLeast = 0.01;
  static constexpr std::size_t kLatest = 20;       // rounds at least, to tell a rate from chance
  static constexpr std::size_t kFirstAnswer = 10;  // takes about as long as so many rounds

  double least_;
  std::vector<std::size_t> counts_;
};

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
