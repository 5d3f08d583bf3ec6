// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/link_paths.h"

#include "base/error.h"
#include "base/rounding.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spherule::internal {
namespace {

// To the root.
std::vector<int> joints_above(const RobotModel& robot, int link) {
  std::vector<int> joints;
  for (;;) {
    const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    if (joint < 0) return joints;
    joints.push_back(joint);
    link = robot.joints()[static_cast<std::size_t>(joint)].parent_link;
  }
}

}  // namespace

std::vector<int> joints_between(const RobotModel& robot, int first, int second) {
  std::vector<int> up = joints_above(robot, first);
  std::vector<int> down = joints_above(robot, second);
  while (!up.empty() && !down.empty() && up.back() == down.back()) {
    up.pop_back();
    down.pop_back();
  }
  up.insert(up.end(), down.rbegin(), down.rend());
  return up;
}

std::vector<int> moving_joints(const RobotModel& robot, int first, int second) {
  std::vector<int> joints = joints_between(robot, first, second);
  std::erase_if(
      joints, [&](int joint) { return !robot.joints()[static_cast<std::size_t>(joint)].moves(); });
  return joints;
}

LinkRelations::LinkRelations(const RobotModel& robot)
    : robot_(robot), joints_of_(robot.links().size()) {
  for (std::size_t joint = 0; joint < robot.joints().size(); ++joint) {
    for (const int link : {robot.joints()[joint].parent_link, robot.joints()[joint].child_link}) {
      joints_of_[static_cast<std::size_t>(link)].push_back(static_cast<int>(joint));
    }
  }
}

std::vector<LinkRelations::Relation> LinkRelations::of(
    int first, const std::function<bool(int)>& has_spheres) const {
  struct Reached {
    int link, by_joint;
    int moving;     // joints on the way
    bool is_clear;  // no link before this one has spheres
  };
  std::vector<Relation> relations(joints_of_.size());
  std::vector<Reached> reached{{first, -1, 0, true}};
  while (!reached.empty()) {
    const Reached at = reached.back();
    reached.pop_back();
    const bool is_next = at.moving == 1 && at.is_clear;
    relations[static_cast<std::size_t>(at.link)] = {at.moving == 0 ? Joined::kRigidly
                                                    : is_next      ? Joined::kByOneJoint
                                                                   : Joined::kFurther,
                                                    at.is_clear};
    const bool is_clear = at.is_clear && (at.link == first || !has_spheres(at.link));
    for (const int index : joints_of_[static_cast<std::size_t>(at.link)]) {
      if (index == at.by_joint) continue;
      const Joint& joint = robot_.joints()[static_cast<std::size_t>(index)];
      reached.push_back({joint.parent_link == at.link ? joint.child_link : joint.parent_link, index,
                         at.moving + (joint.moves() ? 1 : 0), is_clear});
    }
  }
  return relations;
}

}  // namespace spherule::internal

// How far a body is from the axes of the joints between it and another (for G6: what that bounds is
// in collide/kernels/plan_vectors.h).
//
// The joints are numbered from the body on; p is a point of it, and r_k its distance from the axis
// of joint k, whose child link has its origin o_k on that.
//
// How large r_k may get. A point of the line of joint k - 1 (where the child link of that has its
// origin) stands still in the link between k - 1 and k, or is shifted there by the position of
// joint k - 1 at most. So p is from the axis of k at most as far as that point is, and farther by
// at most its own distance from that point; and from o_k by at most the distance of these two and
// the same. What of this is no shift is computed once, with all positions at zero.
//
// Rounding. Points and, times their distances, directions are off by `error` at most; a distance
// of two, from which the next one is counted, by less than 3 times as much, and one from an axis by
// less than 4 times. 4 are added to each, so that there is room for positions of prismatic joints
// that are larger by `error` than is said.

namespace spherule::internal {
namespace {

// Of all points of a sphere from the axes of joints, the nearest joint first.
std::vector<double> reaches(const RobotModel& robot, std::span<const Pose> link_poses, double error,
                            std::span<const int> joints, int link, const Sphere& sphere) {
  std::vector<double> result;
  Eigen::Vector3d last = link_poses[static_cast<std::size_t>(link)] * sphere.center;
  double from_last = sphere.radius;
  for (const int j : joints) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    const Pose& child = link_poses[static_cast<std::size_t>(joint.child_link)];
    const Eigen::Vector3d offset = last - child.translation();
    const double beside = offset.cross(child.matrix() * joint.axis).norm() + 4.0 * error;
    result.push_back(joint.turns() ? beside + from_last : 1.0);
    from_last += offset.norm() + 4.0 * error;
    last = child.translation();
  }
  return result;
}

}  // namespace

PathReach::PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
                     std::span<const int> joints, int first_link, const Sphere& first) {
  const std::vector<double> of_first = reaches(robot, link_poses, error, joints, first_link, first);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const bool turns = robot.joints()[static_cast<std::size_t>(joints[k])].turns();
    steps_.push_back({joints[k], turns, of_first[k], 0.0});
  }
}

PathReach::PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
                     std::span<const int> joints, int first_link, const Sphere& first,
                     int second_link, const Sphere& second)
    : PathReach(robot, link_poses, error, joints, first_link, first) {
  const std::vector<int> backwards(joints.rbegin(), joints.rend());
  const std::vector<double> of_second =
      reaches(robot, link_poses, error, backwards, second_link, second);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    steps_[k].second = of_second[steps_.size() - 1 - k];
  }
}

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
                      .position = moving,
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
