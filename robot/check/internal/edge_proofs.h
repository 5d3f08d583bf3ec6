// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/internal/body_pairs.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The configuration at a fraction of a straight motion, rounded.
void take_between(std::span<const double> from, std::span<const double> to, double at,
                  std::vector<double>& configuration);

// Where on a straight motion pairs with boxes, by their indices, are proved free. The margin of
// FreeBoxes is for the rounding of the ends of parts. For one motion after the other.
class EdgeProofs {
 public:
  // `pairs` must outlive it.
  explicit EdgeProofs(const BodyPairs& pairs);

  // Takes a motion, whose ends are kept until the next one.
  void take(std::span<const double> from, std::span<const double> to);

  // At a fraction of it.
  bool is_free_at(std::size_t pair, double at);
  // Everywhere; looked up once.
  bool is_free(std::size_t pair);
  // Those of the lanes in which it is all the way from `half` before to `half` behind `middle`.
  template <std::size_t N>
  unsigned free_parts(std::size_t pair, const std::array<double, N>& middle,
                      const std::array<double, N>& half, unsigned lanes) {
    const FreeBoxes& boxes = boxes_of(pair);
    unsigned free = 0;
    for (std::size_t lane = 0; lane < N; ++lane) {
      if ((lanes >> lane & 1U) == 0) continue;
      take_between(from_, to_, middle[lane] - half[lane], begin_);
      take_between(from_, to_, middle[lane] + half[lane], end_);
      if (boxes.contains_edge(begin_, end_)) free |= 1U << lane;
    }
    return free;
  }

 private:
  const FreeBoxes& boxes_of(std::size_t pair) const { return *pairs_.pairs()[pair].boxes; }

  const BodyPairs& pairs_;
  std::span<const double> from_{};
  std::span<const double> to_{};
  std::vector<double> begin_;
  std::vector<double> end_;
  std::vector<std::int8_t> is_free_;  // of each pair; -1: not known yet
};

}  // namespace spherule::internal
