// SPDX-License-Identifier: BSD-3-Clause
#include "bench/clock.h"

#include <algorithm>
#include <cstddef>

namespace spherule {

double nanoseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::nano>(duration).count();
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// What two readings of the clock with nothing between them say.
double clock_cost() {
  std::vector<double> readings(10001);
  for (double& reading : readings) {
    const auto start = Clock::now();
    reading = nanoseconds(Clock::now() - start);
  }
  std::sort(readings.begin(), readings.end());
  return quantile(readings, 0.5);
}

}  // namespace spherule
