// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

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

}  // namespace spherule::internal
