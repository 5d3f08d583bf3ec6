// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/robots/trajectory_input.h"
#include "robot/check/robot_checker.h"
#include "robot/files/trajectory_file.h"
#include "robot/model/robot_model.h"

#include <optional>
#include <string>

namespace spherule {

// Of motions of a robot with continuous joints: which way these turn, and where that matters.
struct TurnReview {
  std::optional<ContinuousMotion> continuous{};
  TurningMotions turning{};
};

// Which motions of continuous joints will be proved, with warnings of those that a controller may
// execute otherwise. Throws Error, naming the URDF, where the shortest motions cannot be proved.
TurnReview review_turns(const std::string& urdf, const TrajectoryArguments& arguments,
                        ContinuousMotion motion, const RobotModel& robot,
                        const Trajectory& trajectory);

// An angle as the trajectory's file has them: "1.5 rad" or "90 degrees".
std::string angle_text(double radians, bool in_degrees);

// "2 motions turn a continuous joint by more than half a turn, the first from line 1 to ...".
std::string describe(const TurningMotions& turning, bool in_degrees);

// The same trajectory with each configuration where the shortest motion to it ends.
Trajectory ends_of_motions(const RobotModel& robot, const Trajectory& trajectory);

}  // namespace spherule
