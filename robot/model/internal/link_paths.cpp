// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/internal/link_paths.h"

#include <algorithm>
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

bool are_neighbours(const RobotModel& robot, int first, int second,
                    const std::function<bool(int)>& has_spheres) {
  int link = first;
  for (const int index : joints_between(robot, first, second)) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    link = joint.child_link == link ? joint.parent_link : joint.child_link;
    if (link != second && has_spheres(link)) return false;
  }
  return true;
}

Joined how_joined(const RobotModel& robot, int first, int second,
                  const std::function<bool(int)>& has_spheres) {
  const std::vector<int> joints = joints_between(robot, first, second);
  const auto moving = std::count_if(joints.begin(), joints.end(), [&](int index) {
    return robot.joints()[static_cast<std::size_t>(index)].moves();
  });
  if (moving == 0) return Joined::kRigidly;
  const bool is_next = moving == 1 && are_neighbours(robot, first, second, has_spheres);
  return is_next ? Joined::kByOneJoint : Joined::kFurther;
}

}  // namespace spherule::internal
