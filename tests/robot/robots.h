// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "tests/support/random.h"

#include <vector>

namespace spherule::test {

// A mechanism of `joints` random joints: a serial chain, or a tree where `branching`.
RobotModel random_robot(Random& random, int joints, bool branching);

// Makes about half of the moving joints follow others, earlier and later ones, by multipliers of up
// to one and offsets of up to `offset` in magnitude.
void add_random_mimics(Random& random, RobotModel& robot, double offset);

// Positions of all its variables within +-`largest`.
std::vector<double> random_configuration(Random& random, const RobotModel& robot, double largest);

}  // namespace spherule::test
