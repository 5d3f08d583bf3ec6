// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/proof_scope.h"

#include "spheretree/error.h"

#include <cstddef>

namespace spherule::internal {

std::vector<PositionLimits> position_limits(const RobotModel& robot) {
  std::vector<PositionLimits> result;
  for (const int index : robot.variable_joints()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    result.emplace_back(joint.lower, joint.upper);
  }
  return result;
}

void require_proofs_of(const LinkPairs& pairs, const RobotModel& robot, int tool_link) {
  require_proofs_of(pairs, mechanism_fingerprint(robot), robot.links().size(),
                    static_cast<std::size_t>(robot.variable_count()), tool_link);
}

void require_proofs_of(const LinkPairs& pairs, std::uint64_t mechanism, std::size_t links,
                       std::size_t variables, int tool_link) {
  if (pairs.mechanism() != mechanism || pairs.link_count() != links) {
    throw Error("proofs of pairs", "they are of another robot: its links and joints are not these");
  }
  if (pairs.tool_link() != tool_link) {
    throw Error("proofs of pairs", tool_link < 0 ? "they are of a tool alone"
                                                 : "they are of no tool on the object's link");
  }
  for (const LinkPair& pair : pairs.pairs()) {
    for (const FreeBoxes::Variable& variable : pair.boxes.variables()) {
      if (static_cast<std::size_t>(variable.index) < variables) continue;
      throw Error("proofs of pairs", "they read a variable that the robot does not have");
    }
  }
}

void require_never_within(const LinkPairs& pairs, std::span<const PositionLimits> limits) {
  for (const LinkPair& pair : pairs.pairs()) {
    if (pair.verdict != PairVerdict::kNever) continue;
    for (const FreeBoxes::Variable& proved : pair.boxes.variables()) {
      const auto& [lower, upper] = limits[static_cast<std::size_t>(proved.index)];
      if (proved.wraps || (proved.lower <= lower && upper <= proved.upper)) continue;
      throw Error("proofs of pairs", "the limits of a joint are wider than those they hold for");
    }
  }
}

void require_never_holds(const LinkPairs& pairs, const RobotModel& robot) {
  require_proofs_of(pairs, robot);
  require_never_within(pairs, position_limits(robot));
}

}  // namespace spherule::internal
