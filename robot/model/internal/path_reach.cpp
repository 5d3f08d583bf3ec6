// SPDX-License-Identifier: BSD-3-Clause

// Bounds of the velocity and the acceleration of one body as seen from another (for G6).
//
// Of the joints that lie on the way from one body to the other only these matter, whatever moves
// both. Let them be numbered from the first body on, and let joint k change at the constant rate
// w_k. Look from the link behind joint s at a point p of the first body, which joints 1 to s move:
// joint k, that is, takes with it all that is on the first body's side of it. Let z_k be its axis
// and o_k a point of that. With the joint's position x_k,
//     dp / dx_k = z_k x (p - o_k), or z_k for a shift;
//     d2p / dx_j dx_k = z_j x (dp / dx_k) for j >= k if joint j turns, otherwise 0,
// because joint j, nearer to the observer, turns all of what k does. Neither is longer than
// r_k, the distance of p from the axis of k, or 1 for a shift. So the speed of p is at most the sum
// of w_k r_k, and its acceleration at most the sum over k of
//     w_k r_k (w_k t_k + 2 (w_(k+1) t_(k+1) + ... + w_s t_s)),
// t_j being 1 if joint j turns, otherwise 0. The same holds for the second body from the other
// side, and the motion of a point of one as seen from a point of the other, in the directions of
// the link behind s, is at most both together. Any s will do, and the smallest sum over all counts.
// A body that hangs on no joint of the path stands still: s is behind the last.
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
// that are larger by `error` than is said. Sums err by less than kRelativeSlack of them.

#include "robot/model/internal/path_reach.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

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
  second_moves_ = true;
  const std::vector<int> backwards(joints.rbegin(), joints.rend());
  const std::vector<double> of_second =
      reaches(robot, link_poses, error, backwards, second_link, second);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    steps_[k].second = of_second[steps_.size() - 1 - k];
  }
}

PathBounds PathReach::bounds(std::span<const double> rates, std::span<const double> shifts,
                             std::vector<PathBounds>& work) const {
  const std::size_t count = steps_.size();
  // One more joint is passed; `sum` is of those before it.
  const auto pass = [&](const Step& step, double reach, double& shifted, PathBounds& sum) {
    const auto j = static_cast<std::size_t>(step.joint);
    const double rate = rates[j];
    const double way = rate * (step.turns ? reach + shifted : reach);
    if (step.turns) sum.bend += rate * (0.5 * way + sum.speed);
    sum.speed += way;
    if (!step.turns) shifted += shifts[j];
  };
  // Of the second body, behind each joint.
  work.assign(count + 1, {});
  double shifted = 0.0;
  for (std::size_t k = count; second_moves_ && k-- > 0;) {
    work[k] = work[k + 1];
    pass(steps_[k], steps_[k].second, shifted, work[k]);
  }
  PathBounds first;
  PathBounds best{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  shifted = 0.0;
  for (std::size_t s = 0; s <= count; ++s) {
    if (second_moves_ || s == count) {
      best.speed = std::min(best.speed, first.speed + work[s].speed);
      best.bend = std::min(best.bend, first.bend + work[s].bend);
    }
    if (s < count) pass(steps_[s], steps_[s].first, shifted, first);
  }
  return {best.speed * (1.0 + kRelativeSlack), best.bend * (1.0 + kRelativeSlack)};
}

}  // namespace spherule::internal
