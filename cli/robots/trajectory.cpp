// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/trajectory.h"

#include "base/error.h"
#include "cli/files/files.h"
#include "cli/text/print.h"
#include "robot/check/robot_checker.h"
#include "robot/model/kinematics.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Configurations in a row.
Trajectory part_of(const Trajectory& trajectory, std::size_t first, std::size_t count) {
  const auto lines = trajectory.lines.begin() + static_cast<std::ptrdiff_t>(first);
  const auto positions =
      trajectory.positions.begin() + static_cast<std::ptrdiff_t>(first * trajectory.width);
  return {
      .width = trajectory.width,
      .positions = {positions, positions + static_cast<std::ptrdiff_t>(count * trajectory.width)},
      .lines = {lines, lines + static_cast<std::ptrdiff_t>(count)}};
}

TrajectoryInput shard_of(const TrajectoryArguments& arguments, const Trajectory& whole) {
  const std::size_t size = whole.size();
  const bool has_motions = arguments.has_motions && size > 1;
  const ShardRange range = range_of(arguments.shard, has_motions ? size - 1 : size);
  const bool is_last = arguments.shard.index == arguments.shard.of;
  // The end of the last motion.
  const std::size_t end = has_motions && range.count > 0 ? 1 : 0;
  // Of a trajectory with fewer motions than shards, the last one has none, but the last
  // configuration.
  const std::size_t own = range.count + (has_motions && is_last ? 1 : 0);
  return {.trajectory = part_of(whole, range.first, std::max(range.count + end, own)),
          .has_motions = has_motions,
          .first = range.first,
          .own = own,
          .of = size,
          .outside = {}};
}

// An angle as the trajectory's file has them.
std::string angle_text(double radians, bool in_degrees) {
  return in_degrees ? concat(radians / kRadiansPerDegree, " degrees") : concat(radians, " rad");
}

// "2 motions turn a continuous joint by more than half a turn, the first from line 1 to ...".
std::string describe(const TurningMotions& turning, bool in_degrees) {
  return concat(turning.count, turning.count == 1 ? " motion turns" : " motions turn",
                " a continuous joint by more than half a turn, the first from line ", turning.line,
                " to line ", turning.to_line, ": joint ", one_line(turning.joint), " by ",
                angle_text(turning.step, in_degrees));
}

}  // namespace

CLI::Option* add_degrees_flag(CLI::App& command, const std::string& help,
                              TrajectoryArguments& arguments) {
  return command.add_flag("--degrees", arguments.is_in_degrees, help);
}

TrajectoryInput read_configurations(const TrajectoryArguments& arguments, const RobotModel& robot) {
  const AngleUnit unit = arguments.is_in_degrees ? AngleUnit::kDegrees : AngleUnit::kRadians;
  const Trajectory whole = read_trajectory(arguments.file, robot, unit);
  const DegreesGuess guess = arguments.is_in_degrees ? DegreesGuess() : guess_degrees(robot, whole);
  if (guess.looks_so) {
    warn(concat(arguments.file, ": its angles look like degrees: as radians ", guess.beyond, " of ",
                guess.angles, " are beyond the limits of their joints or a turn, as degrees none, ",
                "the first in line ", guess.line, ": joint ", guess.joint, " at ", guess.value,
                "; --degrees reads them as degrees"));
  }
  TrajectoryInput input = shard_of(arguments, whole);
  input.outside = outside_limits(robot, part_of(input.trajectory, 0, input.own));
  if (input.outside.count > 0) {
    warn(arguments.file + ": " + describe(input.outside, input.own, arguments.is_in_degrees));
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
  return concat(outside.count, " of ", configurations, " configurations ",
                outside.count == 1 ? "is" : "are", " outside the joint limits, the first in line ",
                outside.line, ": joint ", one_line(outside.joint), " at ", scale * outside.position,
                unit, ", ", number(scale * std::abs(outside.position - limit), 3), unit,
                is_above ? " above its upper" : " below its lower", " limit of ", scale * limit,
                unit);
}

Trajectory ends_of_motions(const RobotModel& robot, const Trajectory& trajectory) {
  const ShortestMotion shortest(robot);
  Trajectory ends = trajectory;
  std::vector<double> room;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const std::span<const double> end =
        shortest.end_of(trajectory.configuration(i - 1), trajectory.configuration(i), room);
    std::copy(end.begin(), end.end(),
              ends.positions.begin() + static_cast<std::ptrdiff_t>(i * trajectory.width));
  }
  return ends;
}

std::string describe(const TurnReview& turns, bool in_degrees) {
  if (!turns.continuous) return {};
  const bool is_as_given = turns.continuous == ContinuousMotion::kAsGiven;
  std::string text = std::string("continuous joints turn ") +
                     (is_as_given ? "as given, straight from number to number"
                                  : "the shorter way, by at most half a turn");
  if (turns.turning.count > 0) {
    text += "; " + describe(turns.turning, in_degrees);
    if (!is_as_given) {
      text += " as given, here by " + angle_text(turns.turning.shorter, in_degrees);
    }
  }
  return text + "\n";
}

TurnReview review_turns(const std::string& urdf, const TrajectoryArguments& arguments,
                        ContinuousMotion motion, const RobotModel& robot,
                        const Trajectory& trajectory) {
  const ShortestMotion shortest(robot);
  if (!shortest.has_turns()) return {};
  TurnReview review{.continuous = motion, .turning = more_than_half_a_turn(robot, trajectory)};
  const std::string& file = arguments.file;
  if (review.continuous == ContinuousMotion::kAsGiven) {
    if (review.turning.count == 0) return review;
    warn(file + ": " + describe(review.turning, arguments.is_in_degrees) +
         "; that way is proved: OMPL and many controllers go the shorter one, which --continuous "
         "shortest proves");
    return review;
  }
  blame_file(urdf, [&] { shortest.require(); });
  const TurningMotions half = half_a_turn(robot, trajectory);
  if (half.count == 0) return review;
  warn(concat(file, ": of ", half.count, half.count == 1 ? " motion" : " motions",
              " no way is clearly the shorter one, because a continuous joint turns by half a ",
              "turn, the first from line ", half.line, " to line ", half.to_line, ": joint ",
              half.joint, "; a controller may go the other way than what is proved"));
  return review;
}

}  // namespace spherule
