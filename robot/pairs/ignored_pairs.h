// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Pairs of links that are proved never to touch, for lists of ignored pairs.
//
// @code{.cpp}
// #include <spherule/robot/pairs/ignored_pairs.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const auto proofs = spherule::prove_link_pairs(robot, {});  // without bodies: of no pair
// std::vector<spherule::DisabledPair> pairs{{.link_a = "arm", .link_b = "base", .reason = ""}};
// spherule::add_missing_pairs(spherule::pairs_proved_never(robot, proofs), robot, pairs);
// assert(pairs.size() == 1);
// @endcode

#include "robot/files/srdf.h"
#include "robot/pairs/link_pairs.h"

#include <span>
#include <string_view>
#include <vector>

namespace spherule {

// The reason of pairs that are proved never to touch, in lists of ignored pairs.
inline constexpr std::string_view kProvedNeverReason = "Never (proved within the limits)";

// The pairs of links that are proved never to touch, by name, for lists of ignored pairs. Throws
// Error for proofs of another robot, of tighter limits, or of an attached tool.
std::vector<DisabledPair> pairs_proved_never(const RobotModel& robot, const LinkPairs& proofs);

// Appends those of the pairs that are about links of the robot and not known yet, in either order.
void add_missing_pairs(std::span<const DisabledPair> pairs, const RobotModel& robot,
                       std::vector<DisabledPair>& known);

}  // namespace spherule
