// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_mesh_checker.h"

#include <cstddef>
#include <span>

namespace spherule::internal {

// Each throws Error: for an obstacle without a tree; for an index out of range.
void check_obstacles(std::span<const PlacedTree> obstacles);
void check_untested(std::span<const UntestedPair> untested, const RobotModel& robot,
                    std::size_t obstacle_count);

bool is_untested(std::span<const UntestedPair> untested, std::size_t link, std::size_t obstacle);

}  // namespace spherule::internal
