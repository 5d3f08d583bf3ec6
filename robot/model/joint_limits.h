// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which joint of a configuration is beyond its limits?
//
// @code{.cpp}
// #include <spherule/robot/model/joint_limits.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kRevolute,
//                                .lower = -1.0, .upper = 1.0});
// assert(spherule::joint_outside_limits(robot, std::vector{0.5}) == nullptr);
// assert(spherule::joint_outside_limits(robot, std::vector{1.5})->name == "turn");
// @endcode

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
