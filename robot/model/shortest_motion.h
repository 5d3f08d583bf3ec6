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
// within kTurnError of `to` less whole turns (the bound stands in shortest_motion.cpp). Checks of
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
