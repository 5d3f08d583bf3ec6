// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"
#include "robot/model/shortest_motion.h"
#include "spheretree/rounding.h"

#include <cmath>
#include <cstddef>

namespace spherule::internal {

// How far the computed position p of a joint is from the exact one, for |p| <=
// kLargestJointPosition = P; zero unless the joint mimics another. With m the multiplier, o the
// offset, q the variable and u = 2^-53, the product errs by u |m q| and the sum by u |p|, and |m q|
// <= P + |o| up to terms of second order, so that the sum is at most u (2 P + |o|); the factor
// covers those terms.
inline double mimic_error(const Joint& joint) {
  if (joint.mimics < 0) return 0.0;
  return 1.001 * kUnitRoundoff * (2.0 * kLargestJointPosition + std::abs(joint.offset));
}

// How far apart two of these can be anywhere on a motion that is straight in the variables, with
// both its ends within P: the exact position m q + o; the computed one, of the exact q or of a q
// that was computed at that place as (1 - t) q_0 + t q_1; and the position on the straight line
// from one end's computed position to the other's, as computed by the same formula or exactly. With
// e = mimic_error(), the line is within e of the exact position, because its ends are; computing a
// place on it errs by 3 u 2 P; and a computed q errs by 3 u (|q_0| + |q_1|), which moves m q + o by
// 6 u (P + |o|), beside e for rounding. All together at most 2 e + u (12 P + 6 |o|) <= 8 e.
inline double mimic_error_on_edges(const Joint& joint) {
  return 8.0 * mimic_error(joint);
}

// How far the position of a joint is, anywhere on such a motion, from where it is on the exact
// motion whose end was computed by nearest_turn(): that moves the variable by kTurnError at most,
// at the end, and less before. Zero where no motion may be meant so.
inline double turn_error(const RobotModel& robot, const Joint& joint) {
  if (!joint.moves() || !is_periodic(joint)) return 0.0;
  const int leader = robot.variable_joints()[static_cast<std::size_t>(joint.variable)];
  const bool leader_turns = robot.joints()[static_cast<std::size_t>(leader)].turns();
  return leader_turns ? std::abs(joint.multiplier) * kTurnError : 0.0;
}

}  // namespace spherule::internal
