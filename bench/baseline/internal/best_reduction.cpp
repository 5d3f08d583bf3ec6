// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/best_reduction.h"

#include <utility>

namespace spherule::internal {
namespace {

// A radius that is the sum of a clearance and the wanted protrusion may be rounded up.
constexpr double kRounding = 1e-9;

}  // namespace

bool is_better(const std::vector<FittedSphere>& a, const std::vector<FittedSphere>& b,
               const ReductionGoal& goal) {
  const std::pair<double, double> of_a(largest_protrusion(a), static_cast<double>(a.size()));
  const std::pair<double, double> of_b(largest_protrusion(b), static_cast<double>(b.size()));
  if (goal.count > 0) return of_a < of_b;
  const double most = (1.0 + kRounding) * goal.max_protrusion;
  const bool a_holds = of_a.first <= most;
  const bool b_holds = of_b.first <= most;
  if (a_holds != b_holds) return a_holds;
  return a_holds ? of_a.second < of_b.second : of_a < of_b;
}

Reduced reduce(const ReductionTask& task, const ReductionGoal& goal, SphereReduction reduction) {
  switch (reduction) {
    case SphereReduction::kMerge:
      return {reduction, merge(task, goal)};
    case SphereReduction::kBurst:
      return {reduction, burst(task, goal)};
    case SphereReduction::kExpand:
      return {reduction, expand(task, goal)};
    case SphereReduction::kBest:
      break;
  }
  Reduced best = reduce(task, goal, SphereReduction::kMerge);
  for (const SphereReduction other : {SphereReduction::kBurst, SphereReduction::kExpand}) {
    Reduced made = reduce(task, goal, other);
    if (is_better(made.spheres, best.spheres, goal)) best = std::move(made);
  }
  return best;
}

}  // namespace spherule::internal
