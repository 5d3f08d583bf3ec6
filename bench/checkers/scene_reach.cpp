// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/scene_reach.h"

#include <algorithm>
#include <vector>

namespace spherule {

double scene_reach(const Workload& workload) {
  std::vector<double> along(workload.robot.links().size(), 0.0);
  for (std::size_t i = 0; i < along.size(); ++i) {
    const Link& link = workload.robot.links()[i];
    if (link.parent_joint < 0) continue;
    const Joint& joint = workload.robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    along[i] = along[static_cast<std::size_t>(joint.parent_link)] +
               joint.parent_from_joint.translation().norm();
  }
  double reach = 0.0;
  for (const Body& body : workload.bodies) {
    reach = std::max(reach, along[static_cast<std::size_t>(body.link)] + body.part.tree->reach());
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    reach = std::max(reach,
                     obstacle.world_from_part.translation().norm() + obstacle.part.tree->reach());
  }
  return reach;
}

double single_precision_pad(double reach) {
  return 64.0 * 0x1p-24 * reach;
}

}  // namespace spherule
