// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/planning/problems.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/refined_cover.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <vector>

namespace spherule {

// So many motions to plan, between configurations drawn within the limits of the joints: the ends
// are free for both, no obstacle is inside of a link there, and FCL finds the straight motion
// between them in contact. Throws Error if hardly any two ends are so.
std::vector<PlanningProblem> make_arm_problems(const RobotChecker& checker, FclArm& fcl,
                                               std::size_t count, RandomNumbers& random);

}  // namespace spherule
