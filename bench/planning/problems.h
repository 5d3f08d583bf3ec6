// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

struct PlanningProblem {
  ArmPositions start;
  ArmPositions goal;
};

// What the robot does between welds: the first, fourth, ... leads from one of the `places` to the
// home position (the program's first), the next ones to the station behind the fixture post, the
// third, sixth, ... to another of the places. These are drawn from the places that are free for
// `meshes`; always the same. Throws Error if hardly any place is free, or one of the two goals is
// not.
std::vector<PlanningProblem> make_problems(const Workload& workload, Checker& meshes,
                                           std::span<const ArmPositions> places, std::size_t count);

// Of the weld program, those in which the wire is at the metal.
std::vector<ArmPositions> places_at_metal(const Workload& workload);

}  // namespace spherule
