// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/link_mesh.h"
#include "robot/model/robot_description.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// Of each link the first that has the same shapes, number for number: fingers of a hand, legs of a
// walking robot. Itself where no link before has them, and of links without such geometry.
std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry);

}  // namespace spherule::internal
