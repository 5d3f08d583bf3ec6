// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/baseline/medial_axis.h"
#include "bench/baseline/sphere_reduction.h"

#include <vector>

namespace spherule::internal {

// Whether `a` fulfils the goal better: with a wanted count, by protruding less; else by keeping to
// the protrusion, and then by fewer spheres.
bool is_better(const std::vector<FittedSphere>& a, const std::vector<FittedSphere>& b,
               const ReductionGoal& goal);

struct Reduced {
  SphereReduction reduction;  // that made them
  std::vector<FittedSphere> spheres;
};

// What the reduction makes of the task; for kBest, what the best of the three makes.
Reduced reduce(const ReductionTask& task, const ReductionGoal& goal, SphereReduction reduction);

}  // namespace spherule::internal
