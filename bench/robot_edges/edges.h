// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/configuration.h"
#include "bench/studies/random_numbers.h"
#include "robot/model/robot_model.h"

#include <vector>

namespace spherule {

struct Edge {
  Configuration from;
  Configuration to;
};

// Within the limits of the joints.
Configuration random_configuration(const RobotModel& robot, RandomNumbers& random);

// In the direction of another configuration, by up to 1.5 radians of the joint that turns most.
Edge random_edge(const RobotModel& robot, RandomNumbers& random);

// All configurations but the start, which is known to be free, with no more than `step` between
// neighbours in any joint: the end first and then halves of what is left, as planners take them
// (OMPL's DiscreteMotionValidator), so as to meet a contact early.
std::vector<Configuration> samples(const Edge& edge, double step);

}  // namespace spherule
