// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/trajectory.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/files/files.h"
#include "cli/text/print.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_collision.h"
#include "robot/files/robot_description.h"
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

std::string list(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
    text += (i == 0 ? "" : ", ") + one_line(names[i]);
  }
  return text + (names.size() > kMost ? ", ..." : "");
}

const Joint& joint_of(const RobotModel& robot, std::size_t variable) {
  return robot.joints()[static_cast<std::size_t>(robot.variable_joints()[variable])];
}

std::string names_of_variables(const RobotModel& robot) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot.variable_joints().size(); ++i) {
    names.push_back(joint_of(robot, i).name);
  }
  return list(names);
}

// Where the joints stand that a trajectory leaves out.
class OtherJoints {
 public:
  OtherJoints(const TrajectoryArguments& arguments, const RobotModel& robot,
              const std::filesystem::path& srdf)
      : arguments_(arguments),
        robot_(robot),
        configuration_(zero_posture(robot).configuration),
        source_(configuration_.size(), Source::kZero) {
    // States first: a position that is given for a joint is meant for it.
    for (const std::string& text : arguments.at) {
      if (text.find('=') == std::string::npos) take_state(text, srdf);
    }
    for (const std::string& text : arguments.at) {
      if (text.find('=') != std::string::npos) take_position(text);
    }
  }

  const std::vector<double>& configuration() const { return configuration_; }

  // Refuses positions of joints that the file has, and warns of those that nobody gave.
  void review(const Trajectory& trajectory) const {
    std::vector<std::string> left;
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const std::string& name = joint_of(robot_, i).name;
      const bool is_other = std::find(trajectory.others.begin(), trajectory.others.end(), name) !=
                            trajectory.others.end();
      if (!is_other && source_[i] == Source::kPosition) {
        throw Error("--at " + name, arguments_.file + " has positions of this joint");
      }
      if (is_other && source_[i] == Source::kZero) {
        left.push_back(one_line(name) + " at " + position_text(i));
      }
    }
    if (left.empty()) return;
    warn(arguments_.file + ": it leaves out joints, which stay where they are nearest to zero: " +
         list(left) + "; --at NAME=POSITION, or --at and a state of the SRDF, says where");
  }

 private:
  enum class Source { kZero, kState, kPosition };

  std::string position_text(std::size_t variable) const {
    const double position = configuration_[variable];
    if (!joint_of(robot_, variable).turns()) return concat(position, " m");
    return angle_text(position, arguments_.is_in_degrees);
  }

  std::size_t variable_of(const std::string& name, const std::string& option) const {
    const int index = robot_.find_joint(name);
    if (index < 0) {
      throw Error(option, "the robot has no such joint" +
                              internal::did_you_mean(name, robot_.joints(), &Joint::name));
    }
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(index)];
    if (!joint.moves() || joint.mimics >= 0) {
      throw Error(option, joint.moves() ? "the joint follows another" : "the joint is fixed");
    }
    return static_cast<std::size_t>(joint.variable);
  }

  void take_position(const std::string& text) {
    const std::string option = "--at " + text;
    const std::size_t at = text.find('=');
    const std::size_t variable = variable_of(text.substr(0, at), option);
    const auto number = internal::finite_number(text.substr(at + 1));
    if (!number) throw Error(option, "the position is no finite number");
    if (source_[variable] == Source::kPosition) throw Error(option, "the joint is given twice");
    const bool is_angle = joint_of(robot_, variable).turns() && arguments_.is_in_degrees;
    configuration_[variable] = is_angle ? *number * kRadiansPerDegree : *number;
    source_[variable] = Source::kPosition;
  }

  void take_state(const std::string& name, const std::filesystem::path& srdf) {
    const std::string option = "--at " + name;
    if (srdf.empty()) {
      throw Error(option, "is no NAME=POSITION, and no SRDF is given that could name this state");
    }
    std::vector<std::string> known;
    const SemanticDescription semantics = read_srdf(srdf);
    const GroupState* found = nullptr;
    for (const GroupState& state : semantics.group_states) {
      const std::string whole = state.group + "/" + state.name;
      known.push_back(whole);
      if (name != state.name && name != whole) continue;
      if (found != nullptr) {
        throw Error(option, "several groups have a state of this name: write GROUP/STATE, as " +
                                found->group + "/" + found->name);
      }
      found = &state;
    }
    if (found == nullptr) {
      throw Error(option, srdf.string() + " has no such state" +
                              (known.empty() ? "" : "; it has " + list(known)));
    }
    for (const auto& [variable, position] : positions_of(*found, robot_)) {
      configuration_[variable] = position;
      source_[variable] = Source::kState;
    }
  }

  const TrajectoryArguments& arguments_;
  const RobotModel& robot_;
  std::vector<double> configuration_;
  std::vector<Source> source_;  // of each number
};

}  // namespace

CLI::Option* add_degrees_flag(CLI::App& command, const std::string& help,
                              TrajectoryArguments& arguments) {
  return command.add_flag("--degrees", arguments.is_in_degrees, help);
}

CLI::Option* add_at_option(CLI::App& command, TrajectoryArguments& arguments) {
  return command
      .add_option("--at", arguments.at,
                  "Where a joint stands that the file leaves out: NAME=POSITION, or the name of a "
                  "state of the SRDF; may be repeated (default: at zero or the nearest limit, with "
                  "a warning)")
      ->allow_extra_args(false)
      ->type_name("NAME=POSITION");
}

TrajectoryInput read_configurations(const TrajectoryArguments& arguments,
                                    const RobotDescription& description,
                                    const std::filesystem::path& srdf) {
  const RobotModel& robot = description.model;
  const AngleUnit unit = arguments.is_in_degrees ? AngleUnit::kDegrees : AngleUnit::kRadians;
  const OtherJoints others(arguments, robot, srdf);
  const Trajectory whole = read_trajectory(arguments.file, robot, unit, others.configuration());
  others.review(whole);
  if (!whole.has_header && !description.other_joint_order.empty()) {
    warn(arguments.file + ": no line names the joints: the numbers of a line are taken for " +
         names_of_variables(robot) + ", depth first, while the URDF has " +
         list(description.other_joint_order) + "; a first line of names would settle it");
  }
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
