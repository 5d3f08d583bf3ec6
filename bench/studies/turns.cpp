// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/turns.h"

#include "bench/clock.h"

#include <algorithm>
#include <cstddef>

namespace spherule {
namespace {

// Long against the clock and the change of caches, short against a time slice of the machine.
constexpr std::size_t kRun = 1024;

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

}  // namespace

std::vector<double> time_in_turns(std::span<const std::unique_ptr<Checker>> checkers,
                                  std::span<const JointPositions> configurations, int rounds) {
  const std::size_t runs = (configurations.size() + kRun - 1) / kRun;
  // By checker and run, over the rounds.
  std::vector<std::vector<std::vector<double>>> times(checkers.size(),
                                                      std::vector<std::vector<double>>(runs));
  std::vector<std::uint8_t> verdicts(kRun);
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t run = 0; run < runs; ++run) {
      const std::size_t first = run * kRun;
      const auto asked =
          configurations.subspan(first, std::min(kRun, configurations.size() - first));
      for (std::size_t i = 0; i < checkers.size(); ++i) {
        const auto start = Clock::now();
        checkers[i]->check(asked, {verdicts.data(), asked.size()});
        if (round >= 0) times[i][run].push_back(nanoseconds(Clock::now() - start));
      }
    }
  }
  std::vector<double> result;
  for (auto& of_checker : times) {
    double sum = 0.0;
    for (auto& of_run : of_checker) sum += median(of_run);
    result.push_back(sum / static_cast<double>(configurations.size()));
  }
  return result;
}

std::vector<std::uint8_t> verdicts_of(Checker& checker,
                                      std::span<const JointPositions> configurations) {
  std::vector<std::uint8_t> verdicts(configurations.size());
  checker.check(configurations, verdicts);
  return verdicts;
}

}  // namespace spherule
