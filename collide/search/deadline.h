// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace spherule::internal {

// A limit of time for a query, looked up once in kInterval node tests (a few microseconds) and
// never where there is no limit.
class Deadline {
 public:
  static constexpr std::uint64_t kInterval = 256;
  // What is at least this long is no limit; the clock could not even add the largest duration.
  static constexpr std::chrono::hours kNoLimit{24 * 365};

  explicit Deadline(std::chrono::nanoseconds limit)
      : limited_(limit < kNoLimit),
        end_(limited_ ? std::chrono::steady_clock::now() + limit
                      : std::chrono::steady_clock::time_point()) {}

  // `tests` counts up from call to call. The first call reads the clock, so that a limit of zero
  // ends a query before it starts.
  bool passed(std::uint64_t tests) {
    if (!limited_ || tests < next_) return false;
    next_ = tests + kInterval;
    return std::chrono::steady_clock::now() >= end_;
  }

  // Until then; the largest duration if there is no limit.
  std::chrono::nanoseconds left() const {
    if (!limited_) return std::chrono::nanoseconds::max();
    return std::max(end_ - std::chrono::steady_clock::now(),
                    std::chrono::steady_clock::duration(0));
  }

 private:
  bool limited_;
  std::chrono::steady_clock::time_point end_;
  std::uint64_t next_ = 0;
};

}  // namespace spherule::internal
