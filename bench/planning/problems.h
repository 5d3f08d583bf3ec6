// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// True if `checker` finds a collision.
bool collides(Checker& checker, const ArmPositions& positions);

// The same for the configurations of any robot. Keeps referring to it.
ContactTest contact_test(Checker& checker);

struct PlanningProblem {
  Configuration start;
  Configuration goal;
};

// Whether its ends are free and the straight motion between them is not, at configurations that are
// queried.
bool needs_a_plan(const PlanningProblem& problem, const ContactTest& in_contact);

// What the robot does between welds: the first, third, ... leads from one of the `places` to the
// home position (the program's first), the others to another of the places. These are drawn; the
// ends are free for `meshes` and the straight motion between them is not, at configurations that it
// is queried. Always the same. Throws Error if hardly any two ends are so.
std::vector<PlanningProblem> make_problems(const Workload& workload, Checker& meshes,
                                           std::span<const ArmPositions> places, std::size_t count);

}  // namespace spherule
