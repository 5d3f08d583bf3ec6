// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"
#include "robot/model/robot_model.h"

#include <span>

namespace spherule {

// Whether a tree on any link overlaps a placed obstacle: collides() for each of them, the last link
// first, because the tool at the end of the chain is what usually touches. `world_from_link` as
// forward_kinematics() gives it, one pose a link. A link of the robot against another is no matter
// of this function.
bool robot_collides(const RobotModel& robot, std::span<const Pose> world_from_link,
                    const SphereTree& obstacle, const Pose& world_from_obstacle) noexcept;

}  // namespace spherule
