// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Trajectories from files.
//
// @code{.cpp}
// #include <spherule/robot/files/trajectory_file.h>
// #include <cassert>
// #include <fstream>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.csv";
// std::ofstream(path) << "time,turn\n0,0.5\n1,0.75\n";
// const spherule::Trajectory trajectory = spherule::read_trajectory(path, robot);
// assert(trajectory.size() == 2 && trajectory.configuration(1)[0] == 0.75);
// @endcode

#include "collide/sweep.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Configurations of a robot, in the order of a file.
struct Trajectory {
  std::size_t width = 0;              // numbers of a configuration: the robot's variable_count()
  std::vector<double> positions{};    // one configuration behind the other
  std::vector<std::size_t> lines{};   // of the file, for each configuration; the first line is 1
  bool has_header = false;            // a line of the file names the joints
  std::vector<std::string> others{};  // joints that it does not name

  // How many configurations there are, and one of them.
  std::size_t size() const { return lines.size(); }
  std::span<const double> configuration(std::size_t index) const {
    return std::span(positions).subspan(index * width, width);
  }
};

// In which the numbers of joints that turn are given.
enum class AngleUnit { kRadians, kDegrees };
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// Reads a trajectory: text with a configuration on each line, numbers in radians and metres that
// are separated by commas, semicolons or blanks, their decimals after a point. If the first line
// has a word that is no number, it names the joints, in any order: each that moves and mimics no
// other once; a column named "time" is passed over. Without it the numbers are those of a
// configuration, in their order. Empty lines and what follows a # are passed over.
//
// Joints that the line of names leaves out stand as in the configuration `otherwise`, radians and
// metres; where that is empty, all have to be named.
//
// Degrees are those of joints that turn, revolute and continuous ones; lengths stay metres. They
// become radians as rounded to doubles, each within 4e-16 of itself of the exact ones: what is read
// are these.
//
// Throws Error, whose subject is the file and whose reason names the line: for a file that cannot
// be read, a joint that is unknown, fixed, a mimic, missing or there twice, a line with too few or
// too many numbers, what is no finite number, a line with commas beside semicolons or beside blanks
// that separate (they may be those of decimals), and a file without configurations.
Trajectory read_trajectory(const std::filesystem::path& path, const RobotModel& robot,
                           AngleUnit angles = AngleUnit::kRadians,
                           std::span<const double> otherwise = {});

// What a person should know of a trajectory that is well formed: what it leaves open, or what may
// be meant otherwise.
//
// @code{.cpp}
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kRevolute,
//                                .lower = -2.0, .upper = 2.0});
// const spherule::Trajectory trajectory{.width = 1, .positions = {0, 45, 90}, .lines = {1, 2, 3}};
// assert(spherule::outside_limits(robot, trajectory).count == 2);
// assert(spherule::guess_degrees(robot, trajectory).looks_so);
// @endcode

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
