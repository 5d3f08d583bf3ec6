// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "tests/collide/scene_random.h"

#include <vector>

namespace spherule::test {

// A mechanism of `joints` random joints: a serial chain, or a tree where `branching`.
RobotModel random_robot(SceneRandom& random, int joints, bool branching);

// Makes about half of the moving joints follow others, earlier and later ones, by multipliers of up
// to one and offsets of up to `offset` in magnitude.
void add_random_mimics(SceneRandom& random, RobotModel& robot, double offset);

// Positions of all its variables within +-`largest`.
std::vector<double> random_configuration(SceneRandom& random, const RobotModel& robot,
                                         double largest);

}  // namespace spherule::test
