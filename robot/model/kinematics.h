// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where a robot's links are in a configuration, and motions on which continuous joints turn the
// shorter way.
//
// @code{.cpp}
// #include <spherule/robot/model/kinematics.h>
// #include <cassert>
// #include <numbers>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// std::vector<spherule::Pose> world_from_link;
// spherule::forward_kinematics(robot, std::vector{std::numbers::pi}, world_from_link);
// const Eigen::Vector3d tip = world_from_link[1] * Eigen::Vector3d(1, 0, 0);
// assert((tip - Eigen::Vector3d(-1, 0, 0)).norm() < 1e-14);
// assert(spherule::kinematics_error_bound(robot, 1.0) < 1e-12);
// @endcode

#include "base/rounding.h"
#include "geometry/pose.h"
#include "robot/model/robot_model.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// The largest magnitude of a joint's position, in radians or metres, for which bounds of errors are
// proved.
inline constexpr double kLargestJointPosition = 100.0;

// Poses world_from_link of all links, in the order of RobotModel::links(), for a configuration of
// variable_count() positions (radians or metres; limits are not enforced) and a placed root.
// `world_from_link` is resized and reused, so that a warm call does not allocate.
// `world_from_root` must not be an element of it.
// Throws Error for a configuration of the wrong size or with a number that is not finite, and for
// one that moves a link beyond kMaxCoordinate from the world's origin.
void forward_kinematics(const RobotModel& robot, std::span<const double> configuration,
                        std::vector<Pose>& world_from_link, const Pose& world_from_root = {});

// Bound on the distance between a point at distance at most `reach` from a link's frame mapped by
// the computed pose and by the exact mechanism (the joints exactly as the model stores them), in
// metres, for any configuration with joint positions of at most kLargestJointPosition in
// magnitude and a root at distance at most `root_distance` from the world's origin. The error
// budget stands in kinematics.cpp.
double kinematics_error_bound(const RobotModel& robot, double reach, double root_distance = 0.0);

// Motions on which continuous joints turn the shorter way.
//
// @code{.cpp}
// assert(std::abs(spherule::nearest_turn(3.0, -3.0) - 3.283185307) < 1e-9);  // on through pi
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const spherule::ShortestMotion motion(robot);
// std::vector<double> end;
// assert(motion.end_of(std::vector{3.0}, std::vector{-3.0}, end)[0] > 3.0);
// @endcode

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
