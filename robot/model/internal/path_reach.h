// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "spheretree/sphere.h"

#include <span>
#include <vector>

namespace spherule::internal {

// How far two bodies are at most from the axes of the joints between them, whatever these do. The
// proof is in path_reach.cpp; what follows for motions, in collide/kernels/plan_bounds.h.
class PathReach {
 public:
  struct Step {
    int joint = 0;
    bool turns = false;
    double first = 0.0;   // how far points of the first body are from the axis, without shifts
    double second = 0.0;  // of the second one
  };

  // The joints that move one of the two against the other, from the first body to the second; the
  // first body is in a sphere of the frame of its link, the second in another one, or else it
  // stands still. `link_poses` are those of the robot with all joints at zero; a point mapped by
  // them, or a direction times `error`, may be off by `error`.
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first);
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first, int second_link,
            const Sphere& second);

  // One for each joint, from the first body on.
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

}  // namespace spherule::internal
