// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Motions on which continuous joints turn the shorter way.
//
// @code{.cpp}
// #include <spherule/robot/model/shortest_motion.h>
// #include <cassert>
//
// assert(std::abs(spherule::nearest_turn(3.0, -3.0) - 3.283185307) < 1e-9);  // on through pi
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const spherule::ShortestMotion motion(robot);
// std::vector<double> end;
// assert(motion.end_of(std::vector{3.0}, std::vector{-3.0}, end)[0] > 3.0);
// @endcode

#include "base/rounding.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Whether a turn by 2 pi of the variable that moves this joint leaves it in the same pose, as far
// as the joint's own type and multiplier say.
inline bool is_periodic(const Joint& joint) {
  return joint.turns() && joint.multiplier == std::trunc(joint.multiplier);
}

// The angle at which a motion from `from` ends that turns to the posture of `to` by the shorter
// way: `to` where the two are at most half a turn apart, otherwise `to` less whole turns. Half a
// turn, up to rounding, goes as given, or by whole turns less.
//
// The angle is a rounded number, because 2 pi is none: for |from| and |to| of at most 100 it is
// within kTurnError of `to` less whole turns (the bound stands in kinematics.cpp). Checks of
// motions (RobotChecker) charge that, so that what they prove holds for the exact motion.
double nearest_turn(double from, double to);

// Bound on the rounding of nearest_turn(), in radians, for angles of at most 100 in magnitude.
inline constexpr double kTurnError = 2e-14;

// Motions of a robot on which its continuous joints turn the shorter way (nearest_turn()); other
// joints move straight between the numbers. Immutable.
class ShortestMotion {
 public:
  // Of this robot.
  explicit ShortestMotion(const RobotModel& robot);

  // Throws Error, whose subject is the joint, where a joint mimics a continuous one and is not
  // continuous itself, or has a multiplier that is no whole number: a turn by 2 pi of the one does
  // not bring the other back.
  void require() const;

  // Whether the robot has a continuous joint that a number of a configuration stands for.
  bool has_turns() const { return has_turns_; }
  // Whether the number of a configuration is the position of a continuous joint.
  bool turns(std::size_t variable) const {
    return variable < turns_.size() && turns_[variable] != 0;
  }

  // The end of the motion between two configurations: `to`, or what is written to `end`, which is
  // resized and reused. Throws Error for configurations of another size than the robot's.
  std::span<const double> end_of(std::span<const double> from, std::span<const double> to,
                                 std::vector<double>& end) const;

 private:
  std::vector<std::uint8_t> turns_;  // for each number of a configuration
  bool has_turns_ = false;
  std::string refused_{};  // the joint for which a motion would not end in the same posture
  std::string leader_{};   // that it follows
};

}  // namespace spherule

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
