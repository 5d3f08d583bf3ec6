// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/robot.h"
#include "geometry/pose.h"

#include <vector>

namespace spherule {

// All postures that bring the flange to a place, in closed form (Pieper 1968): the arm forwards or
// backwards, the elbow on either side, the wrist turned over or not. Up to eight, each position in
// [-pi, pi], joint limits not checked; where the wrist is stretched, one of the two that fall
// together there. The place is met up to the rounding of some operations in double. Throws Error
// for a robot whose axes are not z y y x y x with the last three through one point, as those of
// make_robot() are.
std::vector<ArmPositions> inverse_kinematics_branches(const RobotModel& robot,
                                                      const Pose& world_from_flange);

// Limits included.
bool is_within_limits(const RobotModel& robot, const ArmPositions& positions);

}  // namespace spherule
