// SPDX-License-Identifier: BSD-3-Clause
#include "bench/measure.h"

#include <algorithm>
#include <chrono>

namespace spherule {
namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::nano>(duration).count();
}

double quantile(std::vector<double>& sorted, double share) {
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

std::vector<JointPositions> every(const std::vector<JointPositions>& program, std::size_t stride) {
  std::vector<JointPositions> sample;
  for (std::size_t i = 0; i < program.size(); i += stride) sample.push_back(program[i]);
  return sample;
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
  std::vector<Measurement> results(methods.size());
  std::vector<std::vector<double>> rounds(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    results[m].verdicts.resize(program.size());
    methods[m].checker->check(program, results[m].verdicts);  // and warms caches up
  }
  std::vector<std::uint8_t> verdicts(sample.size() + slow_sample.size());
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const auto& timed = methods[m].slow ? slow_sample : sample;
      const auto start = Clock::now();
      methods[m].checker->check(timed, {verdicts.data(), timed.size()});
      const double elapsed = nanoseconds(Clock::now() - start);
      rounds[m].push_back(elapsed / static_cast<double>(timed.size()));
    }
  }
  const double cost = clock_cost();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto& timed = methods[m].slow ? slow_sample : sample;
    std::sort(rounds[m].begin(), rounds[m].end());
    results[m].ns_per_query = rounds[m][rounds[m].size() / 2];
    results[m].timed_queries = timed.size();
    time_single_queries(*methods[m].checker, timed, cost, results[m]);
  }
  return results;
}

}  // namespace spherule
