// SPDX-License-Identifier: BSD-3-Clause
#include "bench/measure.h"

#include "bench/clock.h"
#include "bench/scenes/program.h"

#include <algorithm>

namespace spherule {
namespace {

constexpr std::uint64_t kShuffleSeed = 1;

std::vector<JointPositions> every(const std::vector<JointPositions>& program, std::size_t stride) {
  std::vector<JointPositions> sample;
  for (std::size_t i = 0; i < program.size(); i += stride) sample.push_back(program[i]);
  return sample;
}

double time_per_query(Checker& checker, const std::vector<JointPositions>& timed,
                      std::vector<std::uint8_t>& verdicts) {
  const auto start = Clock::now();
  checker.check(timed, {verdicts.data(), timed.size()});
  return nanoseconds(Clock::now() - start) / static_cast<double>(timed.size());
}

double median(std::vector<double>& rounds) {
  std::sort(rounds.begin(), rounds.end());
  return rounds[rounds.size() / 2];
}

void time_single_queries(Checker& checker, const std::vector<JointPositions>& sample, double cost,
                         Measurement& result) {
  std::vector<double> times;
  std::uint8_t verdict = 0;
  for (const JointPositions& configuration : sample) {
    const auto start = Clock::now();
    checker.check({&configuration, 1}, {&verdict, 1});
    times.push_back(std::max(0.0, nanoseconds(Clock::now() - start) - cost));
  }
  std::sort(times.begin(), times.end());
  result.p50_ns = quantile(times, 0.5);
  result.p99_ns = quantile(times, 0.99);
  for (std::size_t i = 0; i < result.percentiles_ns.size(); ++i) {
    result.percentiles_ns[i] = quantile(times, static_cast<double>(i) / 100.0);
  }
}

}  // namespace

std::vector<Measurement> measure(const std::vector<Method>& methods,
                                 const std::vector<JointPositions>& program,
                                 const MeasureOptions& options) {
  const auto sample = every(program, options.stride);
  const auto slow_sample = every(program, options.slow_stride);
  const auto shuffled_sample = shuffled(sample, kShuffleSeed);
  std::vector<Measurement> results(methods.size());
  std::vector<std::vector<double>> rounds(methods.size());
  std::vector<std::vector<double>> shuffled_rounds(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    results[m].verdicts.resize(program.size());
    methods[m].checker->check(program, results[m].verdicts);  // and warms caches up
  }
  std::vector<std::uint8_t> verdicts(sample.size() + slow_sample.size());
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const auto& timed = methods[m].slow ? slow_sample : sample;
      rounds[m].push_back(time_per_query(*methods[m].checker, timed, verdicts));
      if (methods[m].slow) continue;
      shuffled_rounds[m].push_back(time_per_query(*methods[m].checker, shuffled_sample, verdicts));
    }
  }
  const double cost = clock_cost();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto& timed = methods[m].slow ? slow_sample : sample;
    results[m].ns_per_query = median(rounds[m]);
    if (!methods[m].slow) results[m].shuffled_ns_per_query = median(shuffled_rounds[m]);
    results[m].timed_queries = timed.size();
    time_single_queries(*methods[m].checker, timed, cost, results[m]);
  }
  return results;
}

}  // namespace spherule
