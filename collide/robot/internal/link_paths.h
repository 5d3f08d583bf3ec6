// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_model.h"

#include <vector>

namespace spherule::internal {

// The joints between two links, by their indices, from the first link to the second: up to the last
// link that both hang from, and down again.
std::vector<int> joints_between(const RobotModel& robot, int first, int second);

}  // namespace spherule::internal
