// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/internal/moving_frames.h"

#include "robot/model/internal/mimic_error.h"
#include "robot/model/kinematics.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spherule::internal {
namespace {

// A rotation that takes the z axis to another unit vector, to a few units in the last place: where
// that points backwards, after a half turn, since between opposite vectors there is none to tell.
// Eigen's FromTwoVectors() does the same and takes ten seconds to compile.
Eigen::Quaterniond turn_from_z_to(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d to = axis.normalized();
  const double sign = to.z() >= 0.0 ? 1.0 : -1.0;
  const double twice_w = std::sqrt((1.0 + sign * to.z()) * 2.0);
  const double scale = sign / twice_w;
  const Eigen::Quaterniond turn(0.5 * twice_w, -to.y() * scale, to.x() * scale, 0.0);
  return sign > 0.0 ? turn : turn * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
}

}  // namespace

MovingFrames::MovingFrames(const RobotModel& robot)
    : frame_of_link(robot.links().size(), -1), frame_from_link(robot.links().size()) {
  for (std::size_t link = 1; link < robot.links().size(); ++link) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.links()[link].parent_joint)];
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    const Pose frame_from_joint = frame_from_link[parent] * joint.parent_from_joint;
    if (joint.type == JointType::kFixed) {
      frame_of_link[link] = frame_of_link[parent];
      frame_from_link[link] = frame_from_joint;
      continue;
    }
    const Pose joint_from_frame(turn_from_z_to(joint.axis), Eigen::Vector3d::Zero());
    const int moving = static_cast<int>(frames.size());
    frame_of_link[link] = moving;
    frame_from_link[link] = joint_from_frame.inverse();
    frames.push_back({.parent = frame_of_link[parent],
                      .parent_from_frame = frame_from_joint * joint_from_frame,
                      .variable = moving,
                      .prismatic = joint.type == JointType::kPrismatic});
  }
}

// The error of forward_kinematics(); that of the frames' own poses, of which a link has at most
// four compositions a joint with 80 u of the lengths involved each, and a turn of the axis, of less
// than 40 u; and the slack of the canonical test, 152 u of the scene. All are bounded for the whole
// robot and scene at once. Where joints mimic others, and where turns of joints are taken off,
// what a position may be off on a straight motion turns or shifts what lies beyond.
MovingPoseError moving_pose_error(const RobotModel& robot, double reach, double scene,
                                  double root_distance) {
  constexpr double kErrorOfLengths = 360.0 * kUnitRoundoff;  // for each joint, and two more
  double length = 0.0;
  double turned = 0.0;
  double shifted = 0.0;
  for (const Joint& joint : robot.joints()) {
    length += joint.parent_from_joint.translation().norm() +
              (joint.type == JointType::kPrismatic ? kLargestJointPosition : 0.0);
    (joint.turns() ? turned : shifted) += mimic_error_on_edges(joint) + turn_error(robot, joint);
  }
  const double all = std::max(reach + length, scene) + root_distance;
  if (!(all <= kMaxCoordinate)) throw Error("robot", "it or an obstacle reaches too far");
  const double joints = static_cast<double>(robot.joints().size());
  const double error = kinematics_error_bound(robot, reach, root_distance) +
                       kErrorOfLengths * (joints + 2.0) * all + turned * (reach + length) + shifted;
  // `size` is at least (joints + 2) times `all`.
  return {error, error / kErrorOfLengths};
}

}  // namespace spherule::internal
