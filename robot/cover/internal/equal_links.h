// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/link_mesh.h"
#include "robot/model/robot_description.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// For each link the index of the first link that has the same shapes, number for number: fingers of
// a hand, legs of a walking robot. A link's own index where no earlier link has the same shapes, or
// where it has none.
std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry);

}  // namespace spherule::internal
