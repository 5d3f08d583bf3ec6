// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a person should know of a trajectory that is well formed: what it leaves open, or what may
// be meant otherwise.
//
// @code{.cpp}
// #include <spherule/robot/files/trajectory_review.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kRevolute,
//                                .lower = -2.0, .upper = 2.0});
// const spherule::Trajectory trajectory{.width = 1, .positions = {0, 45, 90}, .lines = {1, 2, 3}};
// assert(spherule::outside_limits(robot, trajectory).count == 2);
// assert(spherule::guess_degrees(robot, trajectory).looks_so);
// @endcode

#include "collide/edge.h"
#include "robot/files/trajectory_file.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <string>

namespace spherule {

// Configurations with a joint outside its limits. A straight motion between two configurations that
// have none stays within the limits.
struct OutsideLimits {
  std::size_t count = 0;  // of configurations
  // In the first of them: its line, and the first such joint. Radians where it turns, or metres.
  std::size_t line = 0;
  std::string joint{};
  bool turns = false;
  double position = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

// Compares each configuration with the limits, as numbers; none of a continuous joint is outside.
OutsideLimits outside_limits(const RobotModel& robot, const Trajectory& trajectory);

// Whether the angles of a trajectory that was read as radians look like degrees: of those that are
// not 0 a quarter at least is beyond the limits of its joint (of a continuous one beyond a turn),
// one is larger than a turn, and as degrees all are within.
struct DegreesGuess {
  bool looks_so = false;
  std::size_t beyond = 0;  // of so many angles
  std::size_t angles = 0;  // that are not 0
  // The first that is beyond.
  std::size_t line = 0;
  std::string joint{};
  double value = 0.0;
};

// Guesses as DegreesGuess says.
DegreesGuess guess_degrees(const RobotModel& robot, const Trajectory& trajectory);

// Motions from one configuration to the next on which some continuous joint that the configurations
// name turns in a way that may not be the one that is meant.
struct TurningMotions {
  std::size_t count = 0;  // of motions
  // The first of them: the lines of its ends, and the first such joint.
  std::size_t line = 0;
  std::size_t to_line = 0;
  std::string joint{};
  double step = 0.0;     // as the numbers say
  double shorter = 0.0;  // by whole turns less
};

// Those that differ by more than half a turn as given.
TurningMotions more_than_half_a_turn(const RobotModel& robot, const Trajectory& trajectory);

// Those that turn by half a turn, up to 1e-4 rad, which numbers of a few digits round away: neither
// way is the shorter one.
TurningMotions half_a_turn(const RobotModel& robot, const Trajectory& trajectory);

}  // namespace spherule
