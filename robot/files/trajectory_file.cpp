// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/trajectory_file.h"

#include "robot/files/internal/text_lines.h"
#include "spheretree/atomic_file.h"
#include "spheretree/error.h"
#include "spheretree/text/nearest_name.h"
#include "spheretree/text/text.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace spherule {
namespace {

constexpr std::string_view kTime = "time";
constexpr int kPassedOver = -1;

class Reader {
 public:
  Reader(std::string file, const RobotModel& robot, AngleUnit angles)
      : file_(std::move(file)), robot_(robot) {
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
        has_header_ = true;
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
    const auto missing = std::find(seen.begin(), seen.end(), 0);
    if (missing == seen.end()) return;
    const auto variable = static_cast<std::size_t>(missing - seen.begin());
    refuse("joint " + internal::in_quotes(name_of_variable(variable)) + " is missing");
  }

  void number_columns() {
    for (int i = 0; i < robot_.variable_count(); ++i) columns_.push_back(i);
  }

  void take_configuration(const std::vector<std::string_view>& words) {
    if (words.size() != columns_.size()) {
      refuse("has " + std::to_string(words.size()) + " numbers instead of " +
             std::to_string(columns_.size()) + (has_header_ ? "" : ": " + all_names()));
    }
    const std::size_t at = trajectory_.positions.size();
    trajectory_.positions.resize(at + trajectory_.width);
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
  std::vector<char> is_in_degrees_{};  // for each variable
  std::vector<int> columns_;           // the variable in each, or kPassedOver
  std::size_t line_ = 0;
  bool has_header_ = false;
  Trajectory trajectory_;
};

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path, const RobotModel& robot,
                           AngleUnit angles) {
  if (robot.variable_count() == 0) throw Error(path.string(), "the robot has no joint that moves");
  return Reader(path.string(), robot, angles).read(read_file(path));
}

}  // namespace spherule
