// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
