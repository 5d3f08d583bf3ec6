// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <cstddef>
#include <random>
#include <span>

namespace spherule::internal {

// Draws positions evenly between the limits of the joints that the variables move; turning joints
// without limits get a whole turn. `configuration` has variable_count() numbers.
inline void draw_configuration(const RobotModel& robot, std::mt19937_64& bits,
                               std::span<double> configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const auto joint = static_cast<std::size_t>(robot.variable_joints()[i]);
    const double lower = robot.joints()[joint].lower;
    const double part = static_cast<double>(bits() >> 11) * 0x1p-53;
    configuration[i] = lower + (robot.joints()[joint].upper - lower) * part;
  }
}

}  // namespace spherule::internal
