// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace spherule::internal {

// How many spheres to search for: fewer by a step than are proved. The step is halved where the
// search fails and doubled where it succeeds.
class CoverGoal {
 public:
  std::size_t target() const { return target_; }
  // Half the way to what is proved, below it.
  std::size_t easier() const { return std::min(proved_ - 1, (target_ + proved_) / 2); }

  void failed() {
    target_ = easier();
    step_ = std::max<std::size_t>(1, step_ / 2);
  }
  void reached(std::size_t count) {
    const std::size_t largest = largest_step(count);
    step_ = proved_ == 0 ? largest : std::min(largest, count <= target_ ? 2 * step_ : step_);
    proved_ = count;
    aim();
  }
  // By how many spheres fewer than `count` are searched for at most.
  static std::size_t largest_step(std::size_t count) {
    constexpr std::size_t kPart = 8;
    return std::max<std::size_t>(1, count / kPart);
  }
  // From here on in steps of a small part of the count.
  void restart() {
    constexpr std::size_t kShare = 32;
    step_ = std::max<std::size_t>(1, proved_ / kShare);
    aim();
  }

 private:
  void aim() { target_ = proved_ - std::min(step_, std::max<std::size_t>(1, proved_) - 1); }

  std::size_t target_ = 0;
  std::size_t proved_ = 0;
  std::size_t step_ = 1;
};

}  // namespace spherule::internal
