// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_collision.h"

#include "spheretree/moved_from.h"

#include <cassert>

namespace spherule {

bool robot_collides(const RobotModel& robot, std::span<const Pose> world_from_link,
                    const SphereTree& obstacle, const Pose& world_from_obstacle) noexcept {
  const std::vector<Link>& links = robot.links();
  internal::require_content(!links.empty(), "RobotModel");
  internal::require_content(obstacle.node_count() > 0, "SphereTree");
  assert(world_from_link.size() == links.size());
  for (std::size_t i = links.size(); i-- > 0;) {
    for (const auto& tree : links[i].trees) {
      if (collides(*tree, world_from_link[i], obstacle, world_from_obstacle)) return true;
    }
  }
  return false;
}

}  // namespace spherule
