// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <functional>
#include <vector>

namespace spherule::internal {

// The joints between two links, by their indices, from the first link to the second: up to the last
// link that both hang from, and down again.
std::vector<int> joints_between(const RobotModel& robot, int first, int second);
// Of these the ones that move.
std::vector<int> moving_joints(const RobotModel& robot, int first, int second);

enum class Joined {
  kRigidly,     // no joint moves them against each other
  kByOneJoint,  // that moves, directly or past links without spheres
  kFurther,     // neither
};

// How the links of a robot hang together.
class LinkRelations {
 public:
  struct Relation {
    Joined joined = Joined::kRigidly;
    bool are_neighbours = true;  // no link between them has spheres
  };

  // Of a robot that outlives it.
  explicit LinkRelations(const RobotModel& robot);

  // Of one link to every other, by the index of the other. One traversal, linear in the links: a
  // path for each pair makes long chains cubic. `has_spheres` is called with indices of links.
  std::vector<Relation> of(int first, const std::function<bool(int)>& has_spheres) const;

 private:
  const RobotModel& robot_;
  std::vector<std::vector<int>> joints_of_;  // of each link, to its parent and its children
};

}  // namespace spherule::internal
