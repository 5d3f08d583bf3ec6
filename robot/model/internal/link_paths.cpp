// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/internal/link_paths.h"

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
