// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// The lower and the upper limit of a variable of a robot; -pi and pi of continuous joints.
using PositionLimits = std::pair<double, double>;

// Of each variable.
std::vector<PositionLimits> position_limits(const RobotModel& robot);

// Throws Error unless the proofs are of a mechanism with that fingerprint and so many links and
// variables, and of a tool on `tool_link`, or of the links themselves (-1).
void require_proofs_of(const LinkPairs& pairs, std::uint64_t mechanism, std::size_t links,
                       std::size_t variables, int tool_link = -1);
void require_proofs_of(const LinkPairs& pairs, const RobotModel& robot, int tool_link = -1);

// Throws Error unless each two links that are proved never to touch are so wherever these limits
// let the joints be.
void require_never_within(const LinkPairs& pairs, std::span<const PositionLimits> limits);
// Both, of a robot's links and limits.
void require_never_holds(const LinkPairs& pairs, const RobotModel& robot);

}  // namespace spherule::internal
