// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/trajectory_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {
namespace {

constexpr std::string_view kTime = "time";
constexpr int kPassedOver = -1;

class Reader {
 public:
  Reader(std::string file, const RobotModel& robot, AngleUnit angles,
         std::span<const double> otherwise)
      : file_(std::move(file)), robot_(robot), otherwise_(otherwise) {
    for (const int joint : robot.variable_joints()) {
      const bool turns = robot.joints()[static_cast<std::size_t>(joint)].turns();
      is_in_degrees_.push_back(turns && angles == AngleUnit::kDegrees ? 1 : 0);
    }
  }

  Trajectory read(std::string_view text) {
    trajectory_.width = static_cast<std::size_t>(robot_.variable_count());
    internal::TextLines lines(text, file_);
    bool first = true;
    while (lines.next()) {
      line_ = lines.number();
      if (first && is_header(lines.words())) {
        trajectory_.has_header = true;
        take_header(lines.words());
      } else {
        if (first) number_columns();
        take_configuration(lines.words());
      }
      first = false;
    }
    if (trajectory_.size() == 0) throw Error(file_, "it has no configuration");
    return std::move(trajectory_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(file_, "line " + std::to_string(line_) + ": " + reason);
  }

  // "nan" or "1e400" in the first line is a faulty configuration, not a joint of that name.
  static bool is_header(const std::vector<std::string_view>& words) {
    return std::any_of(words.begin(), words.end(), [](std::string_view word) {
      return !word.empty() && !internal::has_form_of_number(word);
    });
  }

  std::string name_of_variable(std::size_t variable) const {
    const auto joint = static_cast<std::size_t>(robot_.variable_joints()[variable]);
    return robot_.joints()[joint].name;
  }

  std::string all_names() const {
    std::string names;
    for (std::size_t i = 0; i < trajectory_.width; ++i) {
      names += (i == 0 ? "" : ", ") + name_of_variable(i);
    }
    return names;
  }

  int variable_of(std::string_view word) const {
    const std::string name(word);
    const int index = robot_.find_joint(name);
    if (index < 0) {
      refuse("the robot has no joint " + internal::in_quotes(name) +
             internal::did_you_mean(name, robot_.joints(), &Joint::name));
    }
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(index)];
    if (!joint.moves())
      refuse("joint " + internal::in_quotes(name) + " is fixed and has no position");
    if (joint.mimics >= 0)
      refuse("joint " + internal::in_quotes(name) + " mimics another; leave it out");
    return joint.variable;
  }

  void take_header(const std::vector<std::string_view>& words) {
    std::vector<char> seen(trajectory_.width, 0);
    for (const std::string_view word : words) {
      if (word == kTime && robot_.find_joint(word) < 0) {
        columns_.push_back(kPassedOver);
        continue;
      }
      columns_.push_back(variable_of(word));
      char& there = seen[static_cast<std::size_t>(columns_.back())];
      if (there != 0) refuse("joint " + internal::in_quotes(word) + " is there twice");
      there = 1;
    }
    for (std::size_t variable = 0; variable < seen.size(); ++variable) {
      if (seen[variable] != 0) continue;
      const std::string name = name_of_variable(variable);
      if (otherwise_.empty()) refuse("joint " + internal::in_quotes(name) + " is missing");
      trajectory_.others.push_back(name);
    }
    if (trajectory_.others.size() == seen.size()) refuse("it names no joint of the robot");
  }

  void number_columns() {
    for (int i = 0; i < robot_.variable_count(); ++i) columns_.push_back(i);
  }

  void take_configuration(const std::vector<std::string_view>& words) {
    if (words.size() != columns_.size()) {
      refuse("has " + std::to_string(words.size()) + " numbers instead of " +
             std::to_string(columns_.size()) +
             (trajectory_.has_header
                  ? ""
                  : ": " + all_names() + "; a first line of names says which joints they are"));
    }
    const std::size_t at = trajectory_.positions.size();
    trajectory_.positions.resize(at + trajectory_.width);
    std::copy(otherwise_.begin(), otherwise_.end(),
              trajectory_.positions.begin() + static_cast<std::ptrdiff_t>(at));
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::optional<double> number = internal::finite_number(words[i]);
      if (!number) refuse(internal::in_quotes(words[i]) + " is not a finite number");
      if (columns_[i] == kPassedOver) continue;
      const auto variable = static_cast<std::size_t>(columns_[i]);
      trajectory_.positions[at + variable] =
          is_in_degrees_[variable] != 0 ? *number * kRadiansPerDegree : *number;
    }
    trajectory_.lines.push_back(line_);
  }

  const std::string file_;
  const RobotModel& robot_;
  const std::span<const double> otherwise_;
  std::vector<char> is_in_degrees_{};  // for each variable
  std::vector<int> columns_;           // the variable in each, or kPassedOver
  std::size_t line_ = 0;
  Trajectory trajectory_;
};

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path, const RobotModel& robot,
                           AngleUnit angles, std::span<const double> otherwise) {
  if (robot.variable_count() == 0) throw Error(path.string(), "the robot has no joint that moves");
  if (!otherwise.empty() && otherwise.size() != static_cast<std::size_t>(robot.variable_count())) {
    throw Error("configuration",
                "it is not of this robot: it has " + std::to_string(otherwise.size()) + " numbers");
  }
  return Reader(path.string(), robot, angles, otherwise).read(read_file(path));
}

namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
// Limits are given in few digits, too, and degrees that are rounded may be beyond them.
constexpr double kLimitRounding = 1e-2;

// Whose position a number of a configuration is.
const Joint& leader_of(const RobotModel& robot, std::size_t variable) {
  return robot.joints()[static_cast<std::size_t>(robot.variable_joints()[variable])];
}

// Continuous joints make a few turns at most.
bool is_plausible(const Joint& joint, double angle, double turns) {
  if (!has_limits(joint)) return std::abs(angle) <= turns * kWholeTurn;
  return joint.lower - kLimitRounding <= angle && angle <= joint.upper + kLimitRounding;
}

// Motions of which a continuous joint's `counts(step, shorter)`.
template <class Counts>
TurningMotions turning_motions(const RobotModel& robot, const Trajectory& trajectory,
                               Counts counts) {
  TurningMotions found;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    const std::span<const double> from = trajectory.configuration(i);
    const std::span<const double> to = trajectory.configuration(i + 1);
    for (std::size_t k = 0; k < trajectory.width; ++k) {
      const Joint& joint = leader_of(robot, k);
      if (joint.type != JointType::kContinuous) continue;
      const double step = to[k] - from[k];
      const double shorter = nearest_turn(from[k], to[k]) - from[k];
      if (!counts(step, shorter)) continue;
      if (++found.count == 1) {
        found.line = trajectory.lines[i];
        found.to_line = trajectory.lines[i + 1];
        found.joint = joint.name;
        found.step = step;
        found.shorter = shorter;
      }
      break;
    }
  }
  return found;
}

}  // namespace

OutsideLimits outside_limits(const RobotModel& robot, const Trajectory& trajectory) {
  OutsideLimits found;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::span<const double> configuration = trajectory.configuration(i);
    const Joint* const joint = joint_outside_limits(robot, configuration);
    if (joint == nullptr || ++found.count > 1) continue;
    found.line = trajectory.lines[i];
    found.joint = joint->name;
    found.turns = joint->turns();
    found.position = joint->position(configuration);
    found.lower = joint->lower;
    found.upper = joint->upper;
  }
  return found;
}

DegreesGuess guess_degrees(const RobotModel& robot, const Trajectory& trajectory) {
  DegreesGuess guess;
  bool is_large = false;
  bool fits = true;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::span<const double> configuration = trajectory.configuration(i);
    for (std::size_t k = 0; k < trajectory.width; ++k) {
      const Joint& joint = leader_of(robot, k);
      const double value = configuration[k];
      if (!joint.turns() || value == 0.0) continue;
      ++guess.angles;
      is_large = is_large || std::abs(value) > kWholeTurn;
      fits = fits && is_plausible(joint, value * kRadiansPerDegree, 2.0);
      if (is_plausible(joint, value, 1.0) || ++guess.beyond > 1) continue;
      guess.line = trajectory.lines[i];
      guess.joint = joint.name;
      guess.value = value;
    }
  }
  guess.looks_so = is_large && fits && guess.beyond > 0 && 4 * guess.beyond >= guess.angles;
  return guess;
}

TurningMotions more_than_half_a_turn(const RobotModel& robot, const Trajectory& trajectory) {
  return turning_motions(robot, trajectory,
                         [](double step, double shorter) { return step != shorter; });
}

TurningMotions half_a_turn(const RobotModel& robot, const Trajectory& trajectory) {
  constexpr double kNear = 1e-4;
  return turning_motions(robot, trajectory, [](double, double shorter) {
    return std::abs(shorter) >= std::numbers::pi - kNear;
  });
}

}  // namespace spherule
