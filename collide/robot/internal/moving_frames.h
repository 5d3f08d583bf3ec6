// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism_check.h"
#include "collide/robot/robot_model.h"

#include <vector>

namespace spherule::internal {

// The moving frames of a robot: one for each joint that a variable moves, its z axis turned into
// the joint's axis, and where every link stands in the frame that carries it.
struct MovingFrames {
  explicit MovingFrames(const RobotModel& robot);

  std::vector<MechanismFrame> frames;
  std::vector<int> frame_of_link;  // -1: it stands with the root
  std::vector<Pose> frame_from_link;
};

// How far a point of a link, at most `reach` from the link's frame, may be from where the canonical
// poses take it, as seen from the moving frames. `scene` bounds how far obstacles reach, and
// `root_distance` how far the root is, from the world's origin.
// Throws Error if these are too large to be computed with.
double moving_pose_error(const RobotModel& robot, double reach, double scene, double root_distance);

}  // namespace spherule::internal
