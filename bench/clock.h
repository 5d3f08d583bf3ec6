// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <vector>

namespace spherule {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration duration);

double quantile(const std::vector<double>& sorted, double share);

// What two readings of the clock with nothing between them say, in nanoseconds.
double clock_cost();

}  // namespace spherule
