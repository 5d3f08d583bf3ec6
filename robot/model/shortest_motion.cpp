// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/shortest_motion.h"

#include "spheretree/error.h"

#include <algorithm>
#include <numbers>

namespace spherule {

// The rounding that G6 charges. With |from| and |to| at most 100, at most n = 32 turns are taken
// off. The double kTurn is within 2.5e-16 of 2 pi, which n turns multiply to 8e-15. The product is
// not rounded, and the difference, below 128 in magnitude, by at most half a unit in its last
// place, 7.2e-15. Together less than kTurnError.
double nearest_turn(double from, double to) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double step = to - from;
  if (std::abs(step) <= std::numbers::pi) return to;
  return std::fma(-std::round(step / kTurn), kTurn, to);
}

ShortestMotion::ShortestMotion(const RobotModel& robot)
    : turns_(static_cast<std::size_t>(robot.variable_count()), 0) {
  const auto leader_of = [&](const Joint& joint) -> const Joint& {
    const int leader = robot.variable_joints()[static_cast<std::size_t>(joint.variable)];
    return robot.joints()[static_cast<std::size_t>(leader)];
  };
  for (const Joint& joint : robot.joints()) {
    if (!joint.moves() || leader_of(joint).type != JointType::kContinuous) continue;
    turns_[static_cast<std::size_t>(joint.variable)] = 1;
    has_turns_ = true;
    if (joint.type == JointType::kContinuous && is_periodic(joint)) continue;
    if (!refused_.empty()) continue;
    refused_ = joint.name;
    leader_ = leader_of(joint).name;
  }
}

void ShortestMotion::require() const {
  if (refused_.empty()) return;
  throw Error("joint " + refused_,
              "it follows the continuous joint " + leader_ +
                  ", but is not continuous itself with a whole multiplier, so that a motion by the "
                  "shorter way would not bring it to where it is stated to be");
}

std::span<const double> ShortestMotion::end_of(std::span<const double> from,
                                               std::span<const double> to,
                                               std::vector<double>& end) const {
  if (from.size() != turns_.size() || to.size() != turns_.size()) {
    throw Error("configuration", "the ends of a motion have another size than the robot's");
  }
  if (!has_turns_) return to;
  end.assign(to.begin(), to.end());
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (turns(i)) end[i] = nearest_turn(from[i], to[i]);
  }
  return end;
}

}  // namespace spherule
