// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/options/options.h"
#include "robot/check/robot_checker.h"
#include "robot/files/trajectory_file.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <optional>
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
  std::vector<std::string> at{};  // NAME=POSITION and states, of joints that the file leaves out
  bool has_motions = false;       // its shards are of motions, where it has any
  Shard shard{};
};

// Adds --degrees, with what its help says.
CLI::Option* add_degrees_flag(CLI::App& command, const std::string& help,
                              TrajectoryArguments& arguments);

// Adds --at, which may be repeated.
CLI::Option* add_at_option(CLI::App& command, TrajectoryArguments& arguments);

// What is read of this shard, and what of it is outside the limits of the joints. A shard of
// motions has a configuration more, the end of its last motion, unless that is the end of the
// trajectory or the shard is empty: each configuration is counted in one shard.
struct TrajectoryInput {
  Trajectory trajectory;
  bool has_motions = false;
  std::size_t first = 0;  // in the file, of the first configuration
  std::size_t own = 0;    // configurations that are counted here
  std::size_t of = 0;     // configurations of the file, whatever the shard
  OutsideLimits outside;
};

// As read_trajectory(). Joints that the file leaves out stand where --at puts them: at a position,
// or as in a state of the SRDF that is given; the others as in zero_posture(), with a warning.
// Warns of angles that look like degrees, of configurations outside the limits of the joints, and
// of numbers without names where the URDF has the joints in another order, once each.
TrajectoryInput read_configurations(const TrajectoryArguments& arguments,
                                    const RobotDescription& robot,
                                    const std::filesystem::path& srdf = {});

// Throws Error, naming the line and the joint, for a configuration with a position beyond
// RobotChecker::kLargestPosition, of joints that mimic others, too: nothing is proved there.
void require_provable(const RobotModel& robot, const TrajectoryArguments& arguments,
                      const Trajectory& trajectory);

// "2 of 9 configurations are outside the joint limits, the first in line 3: joint ...".
std::string describe(const OutsideLimits& outside, std::size_t configurations, bool in_degrees);

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

// Which way continuous joints turn, as a line for a person; empty of a robot without such motions.
std::string describe(const TurnReview& turns, bool in_degrees);

// The same trajectory with each configuration where the shortest motion to it ends.
Trajectory ends_of_motions(const RobotModel& robot, const Trajectory& trajectory);

}  // namespace spherule
