// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <functional>
#include <vector>

namespace spherule::internal {

// The joints between two links, by their indices, from the first link to the second: up to the last
// link that both hang from, and down again.
std::vector<int> joints_between(const RobotModel& robot, int first, int second);

enum class Joined {
  kRigidly,     // no joint moves them against each other
  kByOneJoint,  // that moves, directly or past links without spheres
  kFurther,     // neither
};

// Whether two links follow each other along the joints: no link between them has spheres.
// `has_spheres` is called with indices of links.
bool are_neighbours(const RobotModel& robot, int first, int second,
                    const std::function<bool(int)>& has_spheres);

// How two links hang together; `has_spheres` is called with indices of links between them.
Joined how_joined(const RobotModel& robot, int first, int second,
                  const std::function<bool(int)>& has_spheres);

}  // namespace spherule::internal
