// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Trajectories from files.
//
// @code{.cpp}
// #include <spherule/robot/files/trajectory_file.h>
// #include <spherule/spheretree/atomic_file.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.csv";
// spherule::write_file_atomically(path, "time,turn\n0,0.5\n1,0.75\n");
// const spherule::Trajectory trajectory = spherule::read_trajectory(path, robot);
// assert(trajectory.size() == 2 && trajectory.configuration(1)[0] == 0.75);
// @endcode

#include "robot/model/robot_model.h"

#include <cstddef>
#include <filesystem>
#include <numbers>
#include <span>
#include <vector>

namespace spherule {

// Configurations of a robot, in the order of a file.
struct Trajectory {
  std::size_t width = 0;             // numbers of a configuration: the robot's variable_count()
  std::vector<double> positions{};   // one configuration behind the other
  std::vector<std::size_t> lines{};  // of the file, for each configuration; the first line is 1

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
// Degrees are those of joints that turn, revolute and continuous ones; lengths stay metres. They
// become radians as rounded to doubles, each within 4e-16 of itself of the exact ones: what is read
// are these.
//
// Throws Error, whose subject is the file and whose reason names the line: for a file that cannot
// be read, a joint that is unknown, fixed, a mimic, missing or there twice, a line with too few or
// too many numbers, what is no finite number, a line with commas beside semicolons or beside blanks
// that separate (they may be those of decimals), and a file without configurations.
Trajectory read_trajectory(const std::filesystem::path& path, const RobotModel& robot,
                           AngleUnit angles = AngleUnit::kRadians);

}  // namespace spherule
