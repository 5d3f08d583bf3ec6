// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/robot.h"

#include <optional>

namespace spherule {

// Joint positions are multiples of 2^-20 radians (one micrometre at a metre's reach): rounding
// hides what the library's sine and cosine do in their last bits, so that every machine gets the
// same.
ArmPositions on_joint_grid(const ArmPositions& positions);

// Damped least squares (Wampler 1986) from a start, so that a sequence of near targets gives a
// continuous motion: positions on the grid that bring the flange within 5 micrometres and 5e-6
// radians of the target, joint limits kept; nothing where 200 steps do not get there.
std::optional<ArmPositions> solve_inverse_kinematics(const RobotModel& robot,
                                                     const Pose& world_from_flange,
                                                     const ArmPositions& start);

}  // namespace spherule
