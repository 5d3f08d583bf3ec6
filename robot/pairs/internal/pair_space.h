// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "robot/pairs/free_boxes.h"
#include "robot/pairs/internal/link_pieces.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Two links, the joints that move between them, and the box of the variables that move those.
struct PairSpace {
  const RobotModel* robot = nullptr;
  int first = 0;
  int second = 0;
  std::vector<int> joints;  // that move, from the first link on
  std::vector<FreeBoxes::Variable> variables;
  const LinkPieces* of_first = nullptr;
  const LinkPieces* of_second = nullptr;
  double error = 0.0;  // kinematics_error_bound() for the larger reach
};

// The variables of joints and the ranges that searches take: the limits of the joint that a
// variable is the position of. One that may turn without limits wraps, unless one of the joints
// mimics it.
std::vector<FreeBoxes::Variable> ranges_of(const RobotModel& robot, std::span<const int> joints);

// Whether ranges of variables are all that the limits allow: of a continuous joint, all turns.
bool take_all_positions(const RobotModel& robot, std::span<const FreeBoxes::Variable> ranges);

// None where the bounds do not hold: too many joints, or positions beyond
// FreeBoxes::kLargestPosition somewhere in the ranges, the other variables at zero.
std::optional<PairSpace> make_pair_space(const RobotModel& robot, int first, int second,
                                         const LinkPieces& of_first, const LinkPieces& of_second);

}  // namespace spherule::internal
