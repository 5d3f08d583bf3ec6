// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/pair_space.h"

#include "robot/model/internal/link_paths.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/internal/pair_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spherule::internal {
namespace {

const Joint& joint_of(const RobotModel& robot, int index) {
  return robot.joints()[static_cast<std::size_t>(index)];
}

// With each variable anywhere in its range, and zero without one.
bool positions_are_small(const RobotModel& robot, std::span<const FreeBoxes::Variable> variables) {
  return std::all_of(robot.joints().begin(), robot.joints().end(), [&](const Joint& joint) {
    if (!joint.moves()) return true;
    double most = 0.0;
    for (const FreeBoxes::Variable& variable : variables) {
      if (variable.index == joint.variable) {
        most = std::max(std::abs(variable.lower), std::abs(variable.upper));
      }
    }
    return most + 1.0 <= FreeBoxes::kLargestPosition &&
           std::abs(joint.multiplier) * (most + 1.0) + std::abs(joint.offset) <=
               FreeBoxes::kLargestPosition;
  });
}

}  // namespace

bool take_all_positions(const RobotModel& robot, std::span<const FreeBoxes::Variable> ranges) {
  return std::all_of(ranges.begin(), ranges.end(), [&](const FreeBoxes::Variable& range) {
    const auto variable = static_cast<std::size_t>(range.index);
    return range.wraps ||
           joint_of(robot, robot.variable_joints()[variable]).type != JointType::kContinuous;
  });
}

std::vector<FreeBoxes::Variable> ranges_of(const RobotModel& robot, std::span<const int> joints) {
  std::vector<FreeBoxes::Variable> result;
  for (const int index : joints) {
    const int variable = joint_of(robot, index).variable;
    const Joint& leader =
        joint_of(robot, robot.variable_joints()[static_cast<std::size_t>(variable)]);
    const auto known = std::find_if(result.begin(), result.end(),
                                    [&](const auto& other) { return other.index == variable; });
    const bool follows = joint_of(robot, index).mimics >= 0;
    if (known != result.end()) {
      known->wraps &= !follows;
      continue;
    }
    result.push_back(
        {variable, leader.type == JointType::kContinuous && !follows, leader.lower, leader.upper});
  }
  return result;
}

std::optional<PairSpace> make_pair_space(const RobotModel& robot, int first, int second,
                                         const LinkPieces& of_first, const LinkPieces& of_second) {
  PairSpace space{&robot, first,     second,     moving_joints(robot, first, second),
                  {},     &of_first, &of_second, 0.0};
  if (space.joints.size() > PairBound::kMostJoints) return std::nullopt;
  space.variables = ranges_of(robot, space.joints);
  if (space.variables.size() > FreeBoxes::kMostVariables ||
      !positions_are_small(robot, space.variables)) {
    return std::nullopt;
  }
  space.error = kinematics_error_bound(robot, std::max(of_first.reach, of_second.reach));
  return space;
}

}  // namespace spherule::internal
