// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The positions of the joints in a configuration, those that mimic others included, and which of
// them are beyond their limits.

#include "robot/model/robot_model.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// From configurations, one number for each variable, to the positions of all joints that move,
// mimics included, in the order of RobotModel::joints(): the positions of the frames of
// a PlanSource. Where no joint mimics another, both are the same numbers and
// nothing is done. Immutable; threads may share it, each with a Scratch of its own.
class JointPositions {
 public:
  // Of the joints of this robot.
  explicit JointPositions(const RobotModel& robot);

  // What is written to: the positions of several configurations.
  struct Scratch {
    std::vector<double> positions{};
  };
  // For so many configurations.
  Scratch scratch_for(std::size_t configurations) const;

  // The positions in a configuration of as many numbers as the robot has variables. The result is a
  // view of `configuration` itself or, with mimics, of `scratch`, where it is kept at a `place`
  // below the number that it was made for. Sizes are not checked. Allocates nothing.
  std::span<const double> of(std::span<const double> configuration, Scratch& scratch,
                             std::size_t place = 0) const {
    return has_mimics_ ? computed(configuration, scratch, place) : configuration;
  }

 private:
  std::span<const double> computed(std::span<const double> configuration, Scratch& scratch,
                                   std::size_t place) const;

  bool has_mimics_;
  std::vector<Joint> moving_{};
};

// Which joint of a configuration is beyond its limits?

// Whether the position of a joint is limited: that of one that moves, is not continuous and has
// limits that are known.
inline bool has_limits(const Joint& joint) {
  return joint.moves() && joint.type != JointType::kContinuous && std::isfinite(joint.upper);
}

// The first joint of a variable that should have limits and has none that are known, or null.
const Joint* joint_without_limits(const RobotModel& robot);
// Throws Error, naming it, where there is one.
void require_limits(const RobotModel& robot);

// The first joint whose position in a configuration of the robot's size is beyond its limits, those
// that mimic others included, or null.
inline const Joint* joint_outside_limits(const RobotModel& robot,
                                         std::span<const double> configuration) {
  for (const Joint& joint : robot.joints()) {
    if (!has_limits(joint)) continue;
    const double position = joint.position(configuration);
    if (!(joint.lower <= position && position <= joint.upper)) return &joint;
  }
  return nullptr;
}

}  // namespace spherule
