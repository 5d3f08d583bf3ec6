// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/measure.h"

#include "base/error.h"
#include "bench/scenes/work_cell.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <utility>

namespace spherule {

double nanoseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::nano>(duration).count();
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : quantile(values, 0.5);
}

// What two readings of the clock with nothing between them say.
double clock_cost() {
  std::vector<double> readings(10001);
  for (double& reading : readings) {
    const auto start = Clock::now();
    reading = nanoseconds(Clock::now() - start);
  }
  return median(std::move(readings));
}

namespace {

constexpr std::uint64_t kShuffleSeed = 1;

std::vector<ArmPositions> every(const std::vector<ArmPositions>& program, std::size_t stride) {
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < program.size(); i += stride) sample.push_back(program[i]);
  return sample;
}

// Parts of a round that are timed by themselves: short against a time slice of the machine, long
// against the clock.
constexpr std::size_t kRun = 256;
constexpr std::size_t kSlowRun = 8;

// One method's times of each run, over the rounds. Of each run the median counts: another task's
// slice of time falls on some runs of a round, on others in the next.
class Rounds {
 public:
  Rounds(const std::vector<ArmPositions>& timed, std::size_t run)
      : timed_(timed), run_(run), times_((timed.size() + run - 1) / run) {}

  void add(Checker& checker, std::vector<std::uint8_t>& verdicts) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const auto queried = timed_.subspan(i * run_, std::min(run_, timed_.size() - i * run_));
      const auto start = Clock::now();
      checker.check(queried, {verdicts.data(), queried.size()});
      times_[i].push_back(nanoseconds(Clock::now() - start));
    }
  }

  double time_per_query() {
    double sum = 0.0;
    for (std::vector<double>& times : times_) {
      std::sort(times.begin(), times.end());
      sum += times[times.size() / 2];
    }
    return sum / static_cast<double>(timed_.size());
  }

 private:
  std::span<const ArmPositions> timed_;
  std::size_t run_;
  std::vector<std::vector<double>> times_;
};

void time_single_queries(Checker& checker, const std::vector<ArmPositions>& sample, double cost,
                         Measurement& result) {
  std::vector<double> times;
  std::uint8_t verdict = 0;
  for (const ArmPositions& configuration : sample) {
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

VerdictCount count(const std::vector<std::uint8_t>& verdicts,
                   const std::vector<std::uint8_t>& truth) {
  VerdictCount result;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool says = verdicts[i] != 0;
    const bool is = truth[i] != 0;
    result.collisions += says ? 1 : 0;
    result.missed += is && !says ? 1 : 0;
    result.extra += says && !is ? 1 : 0;
  }
  return result;
}

std::vector<Measurement> measure(const std::vector<Method>& methods,
                                 const std::vector<ArmPositions>& program,
                                 const MeasureOptions& options) {
  const auto sample = every(program, options.stride);
  const auto slow_sample = every(program, options.slow_stride);
  const auto shuffled_sample = shuffled(sample, kShuffleSeed);
  std::vector<Measurement> results(methods.size());
  std::vector<Rounds> rounds;
  std::vector<Rounds> shuffled_rounds;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const std::size_t run = methods[m].slow ? kSlowRun : kRun;
    rounds.emplace_back(methods[m].slow ? slow_sample : sample, run);
    shuffled_rounds.emplace_back(shuffled_sample, run);
    results[m].verdicts.resize(program.size());
    methods[m].checker->check(program, results[m].verdicts);  // and warms caches up
  }
  std::vector<std::uint8_t> verdicts(kRun);
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      rounds[m].add(*methods[m].checker, verdicts);
      if (!methods[m].slow) shuffled_rounds[m].add(*methods[m].checker, verdicts);
    }
  }
  const double cost = clock_cost();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto& timed = methods[m].slow ? slow_sample : sample;
    results[m].ns_per_query = rounds[m].time_per_query();
    if (!methods[m].slow) results[m].shuffled_ns_per_query = shuffled_rounds[m].time_per_query();
    results[m].timed_queries = timed.size();
    time_single_queries(*methods[m].checker, timed, cost, results[m]);
  }
  return results;
}

void print_fit(const FitRecord& fit) {
  std::printf("  %s: %zu spheres, %.1f s\n", fit.part.c_str(), fit.spheres, fit.seconds);
  std::fflush(stdout);
}

void check_promises(const Simplification& fit, const std::string& part) {
  const std::string broken = broken_promises(fit);
  if (!broken.empty()) throw Error(part, broken);
}

namespace {

FitRecord fit(Part& part, int effort) {
  SimplifyOptions options;
  options.max_error = part.max_error;
  options.min_external_diameter = part.min_external_diameter;
  options.effort = effort;
  const auto start = Clock::now();
  const Simplification result = simplify(part.mesh, options);
  const std::chrono::duration<double> elapsed = Clock::now() - start;
  check_promises(result, part.name);
  part.tree = std::make_shared<const SphereTree>(build_tree(result.cover.spheres));
  return {part.name,
          part.mesh.triangles.size(),
          result.cover.spheres.size(),
          part.max_error,
          part.min_external_diameter,
          elapsed.count(),
          true};
}

}  // namespace

std::vector<FitRecord> fit_parts(Workload& workload,
                                 const std::function<void(const FitRecord&)>& done, int effort) {
  std::vector<FitRecord> records;
  const auto add = [&](Part& part) {
    records.push_back(fit(part, effort));
    done(records.back());
  };
  for (Body& body : workload.bodies) add(body.part);
  for (Obstacle& obstacle : workload.obstacles) add(obstacle.part);
  return records;
}

}  // namespace spherule
