// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <string>
#include <string_view>

namespace spherule::internal {

// Throws Error unless the proofs are of this robot's links and joints, and of a tool on
// `tool_link`, or of the links themselves (-1).
void require_proofs_of(const LinkPairs& pairs, const RobotModel& robot, int tool_link = -1);
// Throws Error, too, unless each two links that are proved never to touch are so wherever the
// robot's limits let the joints be.
void require_never_holds(const LinkPairs& pairs, const RobotModel& robot);

// The content of a file of proofs apart from the file system, for tests; `name` becomes the subject
// of an Error.
std::string encode_link_pairs(const LinkPairs& pairs);
LinkPairs decode_link_pairs(std::string_view bytes, const std::string& name);

}  // namespace spherule::internal
