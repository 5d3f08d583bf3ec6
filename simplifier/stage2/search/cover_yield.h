// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherule::internal {

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

}  // namespace spherule::internal
