// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <span>

namespace spherule {

// Whether the position of a joint is limited: that of one that moves and is not continuous.
inline bool has_limits(const Joint& joint) {
  return joint.moves() && joint.type != JointType::kContinuous;
}

// The first joint whose position in a configuration of the robot's size is beyond its limits, those
// that mimic others included, or null.
inline const Joint* joint_outside_limits(const RobotModel& robot,
                                         std::span<const double> configuration) {
  for (const Joint& joint : robot.joints()) {
    if (!has_limits(joint)) continue;
    const double position = joint.position(configuration);
    if (!(joint.lower <= position && position <= joint.upper)) return &joint;
  }
  return nullptr;
}

}  // namespace spherule
