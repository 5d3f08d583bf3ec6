// SPDX-License-Identifier: BSD-3-Clause

// How far a body is from the axes of the joints between it and another (for G6: what that bounds is
// in collide/kernels/plan_bounds.h).
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

#include "robot/model/internal/path_reach.h"

#include <cstddef>

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

}  // namespace spherule::internal
