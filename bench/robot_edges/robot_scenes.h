// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"
#include "robot/check/robot_scene.h"

namespace spherule {

// The arm in a scene, as a RobotScene. What stands with the arm's root is not tested against the
// scene.
RobotScene robot_scene(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

}  // namespace spherule
