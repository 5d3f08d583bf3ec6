// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/ignored_pairs.h"

#include "robot/pairs/internal/proof_scope.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace spherule {

std::vector<DisabledPair> pairs_proved_never(const RobotModel& robot, const LinkPairs& proofs) {
  internal::require_never_holds(proofs, robot);
  std::vector<DisabledPair> result;
  for (const LinkPair& pair : proofs.pairs()) {
    if (pair.verdict != PairVerdict::kNever) continue;
    result.push_back({robot.links()[static_cast<std::size_t>(pair.first)].name,
                      robot.links()[static_cast<std::size_t>(pair.second)].name,
                      std::string(kProvedNeverReason)});
  }
  return result;
}

void add_missing_pairs(std::span<const DisabledPair> pairs, const RobotModel& robot,
                       std::vector<DisabledPair>& known) {
  for (const DisabledPair& pair : pairs) {
    if (robot.find_link(pair.link_a) < 0 || robot.find_link(pair.link_b) < 0) continue;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const DisabledPair& other) {
      return (other.link_a == pair.link_a && other.link_b == pair.link_b) ||
             (other.link_a == pair.link_b && other.link_b == pair.link_a);
    });
    if (!is_known) known.push_back(pair);
  }
}

}  // namespace spherule
