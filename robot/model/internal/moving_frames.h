// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism_check.h"
#include "robot/model/robot_model.h"

#include <vector>

namespace spherule::internal {

// The moving frames of a robot: one for each joint that moves, its z axis turned into the joint's
// axis, and where every link stands in the frame that carries it. A frame's variable is the
// position of its joint (joint_positions()): a variable of the robot, where no joint mimics
// another.
struct MovingFrames {
  explicit MovingFrames(const RobotModel& robot);

  std::vector<MechanismFrame> frames;
  std::vector<int> frame_of_link;  // -1: it stands with the root
  std::vector<Pose> frame_from_link;
};

// How exact poses are, of all links.
struct MovingPoseError {
  double error = 0.0;  // how far a point of a link may be from where the canonical poses take it
  // At least twice what bounds all lengths of the robot and the scene, positions of joints up to
  // kLargestJointPosition.
  double size = 0.0;
};

// Of points at most `reach` from their link's frame, as seen from the moving frames. `scene` bounds
// how far obstacles reach, and `root_distance` how far the root is, from the world's origin. It
// holds for motions that are straight in the robot's variables, too, where the frames' variables go
// straight from those of one end to those of the other. Throws Error if these are too large to be
// computed with.
MovingPoseError moving_pose_error(const RobotModel& robot, double reach, double scene,
                                  double root_distance);

}  // namespace spherule::internal
