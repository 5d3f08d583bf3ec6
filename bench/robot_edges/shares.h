// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "robot/pairs/allowed_collisions.h"

#include <span>

namespace spherule {

// What the tests of links against each other cost among fifty primitives: with them and without, in
// turns. Prints a table.
void measure_self_share(const Arm& arm, const AllowedCollisions& allowed);

// What more spheres cost: the same questions of each arm in turns, in a scene of primitives. Prints
// a table of times the first arm's.
void measure_sizes(std::span<const Arm> arms, const AllowedCollisions& allowed);

}  // namespace spherule
