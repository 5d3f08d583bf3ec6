// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>
#include <span>
#include <vector>

namespace spherule {

// Nanoseconds a configuration of each checker. They take turns at short runs of the configurations,
// in several rounds; of each run the least time counts, since what else the machine does can only
// add. One more round goes first, untimed.
std::vector<double> time_in_turns(std::span<const std::unique_ptr<Checker>> checkers,
                                  std::span<const ArmPositions> configurations, int rounds);

// What a checker says of all of them.
std::vector<std::uint8_t> verdicts_of(Checker& checker,
                                      std::span<const ArmPositions> configurations);

}  // namespace spherule
