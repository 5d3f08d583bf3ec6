// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/files/trajectory_file.h"
#include "robot/files/trajectory_review.h"
#include "robot/model/robot_model.h"

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spherule {

// A file of configurations, as an argument of a command, and in which unit its angles are.
struct TrajectoryArguments {
  std::string file;
  bool is_in_degrees = false;
};

// Adds --degrees, with what its help says.
CLI::Option* add_degrees_flag(CLI::App& command, const std::string& help,
                              TrajectoryArguments& arguments);

// What is read, and what of it is outside the limits of the joints.
struct TrajectoryInput {
  Trajectory trajectory;
  OutsideLimits outside;
};

// As read_trajectory(). Warns of angles that look like degrees, and of configurations outside the
// limits of the joints, once each.
TrajectoryInput read_configurations(const TrajectoryArguments& arguments, const RobotModel& robot);

// Throws Error, naming the line and the joint, for a configuration with a position beyond
// RobotChecker::kLargestPosition, of joints that mimic others, too: nothing is proved there.
void require_provable(const RobotModel& robot, const TrajectoryArguments& arguments,
                      const Trajectory& trajectory);

// "2 of 9 configurations are outside the joint limits, the first in line 3: joint ...".
std::string describe(const OutsideLimits& outside, std::size_t configurations, bool in_degrees);

}  // namespace spherule
