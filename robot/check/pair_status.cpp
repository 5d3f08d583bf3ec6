// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/pair_status.h"

#include "robot/check/robot_scene.h"

#include <cstddef>
#include <utility>

namespace spherule {

std::vector<PairStatus> pair_statuses(const RobotModel& robot, const AllowedCollisions& allowed,
                                      std::shared_ptr<const LinkPairs> proofs) {
  RobotScene scene(robot);
  scene.set_allowed_collisions(allowed);
  scene.set_link_pairs(proofs);
  std::vector<PairStatus> result;
  const std::vector<Link>& links = robot.links();
  for (std::size_t first = 0; first < links.size(); ++first) {
    for (std::size_t second = first + 1; second < links.size(); ++second) {
      if (links[first].trees.empty() || links[second].trees.empty()) continue;
      PairStatus& status = result.emplace_back();
      status.first = static_cast<int>(first);
      status.second = static_cast<int>(second);
      status.reason = scene.reason(links[first].name, links[second].name);
      const LinkPair* const pair =
          proofs == nullptr ? nullptr : proofs->find(status.first, status.second);
      if (pair == nullptr) continue;
      status.verdict = pair->verdict;
      status.free_share = pair->boxes.free_share();
    }
  }
  return result;
}

std::string_view kind_of(const PairStatus& status) {
  if (status.reason != AllowedReason::kTested || !status.verdict) return name_of(status.reason);
  return *status.verdict == PairVerdict::kTouching ? "can touch" : name_of(*status.verdict);
}

}  // namespace spherule
