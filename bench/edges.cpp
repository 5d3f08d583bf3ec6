// SPDX-License-Identifier: BSD-3-Clause
#include "bench/edges.h"

#include "bench/checkers/tree_checker.h"
#include "bench/clock.h"

#include <algorithm>
#include <vector>

namespace spherule {
namespace {

bool is_free_at_many(const RobotChecker& checker, RobotChecker::Scratch& scratch,
                     const ArmPositions& from, const ArmPositions& to) {
  constexpr int kSteps = 10000;
  for (int step = 0; step <= kSteps; ++step) {
    const double t = static_cast<double>(step) / kSteps;
    ArmPositions at;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = (1.0 - t) * from[i] + t * to[i];
    if (!checker.check_config(at, scratch)) return false;
  }
  return true;
}

}  // namespace

EdgeMeasurement measure_edges(const Workload& workload) {
  const RobotChecker checker = make_robot_checker(workload);
  RobotChecker::Scratch scratch(checker);
  const std::vector<ArmPositions>& program = workload.program;
  checker.check_edge(program[0], program[1], scratch);  // warms the scratch up
  const double cost = clock_cost();
  EdgeMeasurement result;
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < program.size(); ++i) {
    const auto start = Clock::now();
    const EdgeResult edge = checker.check_edge(program[i], program[i + 1], scratch);
    times.push_back(std::max(0.0, nanoseconds(Clock::now() - start) - cost));
    if (edge.verdict == Verdict::kFree) {
      ++result.free;
    } else if (edge.verdict == Verdict::kCollision) {
      ++result.collision;
    } else {
      ++result.unknown;
      if (is_free_at_many(checker, scratch, program[i], program[i + 1])) ++result.unknown_but_free;
    }
  }
  std::sort(times.begin(), times.end());
  result.median_ns = quantile(times, 0.5);
  result.p95_ns = quantile(times, 0.95);
  result.p99_ns = quantile(times, 0.99);
  return result;
}

}  // namespace spherule
