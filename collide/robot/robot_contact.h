// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/contact.h"

#include <cstddef>
#include <limits>

namespace spherule {

// A link of a robot that touches an obstacle.
struct RobotContact {
  int link = 0;              // index into the robot's links()
  std::size_t tree = 0;      // index into the link's trees
  std::size_t obstacle = 0;  // index into the checker's obstacles
  Contact contact;           // a is the link's tree, b the obstacle's; metres
};

// When an explanation may stop.
struct ExplainRequest {
  // Stop after this many links and obstacles that touch (1: the first).
  std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
};

}  // namespace spherule
