// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "collide/robot/robot_checker.h"

namespace spherule {

// The workload's robot among its obstacles, as every engine of the workload is asked: no link is
// tested against another. Its parts must have been fitted.
RobotChecker make_robot_checker(const Workload& workload);

// True if `checker` finds a collision.
bool collides(Checker& checker, const ArmPositions& positions);

}  // namespace spherule
