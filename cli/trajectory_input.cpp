// SPDX-License-Identifier: BSD-3-Clause
#include "cli/trajectory_input.h"

#include "cli/message.h"
#include "robot/check/robot_checker.h"
#include "spheretree/error.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace spherule {

CLI::Option* add_degrees_flag(CLI::App& command, const std::string& help,
                              TrajectoryArguments& arguments) {
  return command.add_flag("--degrees", arguments.is_in_degrees, help);
}

TrajectoryInput read_configurations(const TrajectoryArguments& arguments, const RobotModel& robot) {
  const AngleUnit unit = arguments.is_in_degrees ? AngleUnit::kDegrees : AngleUnit::kRadians;
  TrajectoryInput input{read_trajectory(arguments.file, robot, unit), {}};
  const DegreesGuess guess =
      arguments.is_in_degrees ? DegreesGuess() : guess_degrees(robot, input.trajectory);
  if (guess.looks_so) {
    std::ostringstream text;
    text << arguments.file << ": its angles look like degrees: as radians " << guess.beyond
         << " of " << guess.angles
         << " are beyond the limits of their joints or a turn, as degrees none, the first in line "
         << guess.line << ": joint " << guess.joint << " at " << guess.value
         << "; --degrees reads them as degrees";
    warn(text.str());
  }
  input.outside = outside_limits(robot, input.trajectory);
  if (input.outside.count > 0) {
    warn(arguments.file + ": " +
         describe(input.outside, input.trajectory.size(), arguments.is_in_degrees));
  }
  return input;
}

void require_provable(const RobotModel& robot, const TrajectoryArguments& arguments,
                      const Trajectory& trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    for (const Joint& joint : robot.joints()) {
      const double position = joint.position(trajectory.configuration(i));
      if (std::abs(position) <= RobotChecker::kLargestPosition) continue;
      throw Error(arguments.file, "line " + std::to_string(trajectory.lines[i]) + ": joint " +
                                      joint.name +
                                      " is at a position beyond 100, of which nothing is proved");
    }
  }
}

std::string describe(const OutsideLimits& outside, std::size_t configurations, bool in_degrees) {
  const double scale = outside.turns && in_degrees ? 1.0 / kRadiansPerDegree : 1.0;
  const char* const unit = !outside.turns ? " m" : in_degrees ? " degrees" : " rad";
  const bool is_above = outside.position > outside.upper;
  const double limit = is_above ? outside.upper : outside.lower;
  std::ostringstream text;
  text << outside.count << " of " << configurations << " configurations "
       << (outside.count == 1 ? "is" : "are") << " outside the joint limits, the first in line "
       << outside.line << ": joint " << outside.joint << " at " << scale * outside.position << unit
       << ", " << std::setprecision(3) << scale * std::abs(outside.position - limit) << unit
       << std::setprecision(6) << (is_above ? " above its upper" : " below its lower")
       << " limit of " << scale * limit << unit;
  return text.str();
}

}  // namespace spherule
