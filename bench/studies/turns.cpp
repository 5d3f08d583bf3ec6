// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/turns.h"

#include "bench/clock.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace spherule {
namespace {

// Long against the clock and the change of caches, short against a time slice of the machine.
constexpr std::size_t kRun = 1024;

}  // namespace

std::vector<double> time_in_turns(std::span<const std::unique_ptr<Checker>> checkers,
                                  std::span<const ArmPositions> configurations, int rounds) {
  const std::size_t runs = (configurations.size() + kRun - 1) / kRun;
  // By checker and run: the least so far.
  std::vector<std::vector<double>> least(
      checkers.size(), std::vector<double>(runs, std::numeric_limits<double>::infinity()));
  std::vector<std::uint8_t> verdicts(kRun);
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t run = 0; run < runs; ++run) {
      const std::size_t first = run * kRun;
      const auto queried =
          configurations.subspan(first, std::min(kRun, configurations.size() - first));
      for (std::size_t i = 0; i < checkers.size(); ++i) {
        const auto start = Clock::now();
        checkers[i]->check(queried, {verdicts.data(), queried.size()});
        const double time = nanoseconds(Clock::now() - start);
        if (round >= 0) least[i][run] = std::min(least[i][run], time);
      }
    }
  }
  std::vector<double> result;
  for (const auto& of_checker : least) {
    const double sum = std::accumulate(of_checker.begin(), of_checker.end(), 0.0);
    result.push_back(sum / static_cast<double>(configurations.size()));
  }
  return result;
}

std::vector<std::uint8_t> verdicts_of(Checker& checker,
                                      std::span<const ArmPositions> configurations) {
  std::vector<std::uint8_t> verdicts(configurations.size());
  checker.check(configurations, verdicts);
  return verdicts;
}

}  // namespace spherule
