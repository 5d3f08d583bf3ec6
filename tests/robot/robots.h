// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "tests/support/random.h"

#include <string>
#include <vector>

namespace spherule::test {

// Joints: along x, about z with and without limits.
Joint sliding(double lower, double upper, std::string name = {},
              const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX());
Joint turning(double lower, double upper, std::string name = {});
Joint wheel(std::string name = {}, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ());

// A base without spheres, and below this joint a link "arm" with one sphere.
RobotModel one_arm(const Joint& joint, const Eigen::Vector3d& center, double radius);

// A mechanism of `joints` random joints: a serial chain, or a tree where `branching`.
RobotModel random_robot(Random& random, int joints, bool branching);

// Makes about half of the moving joints follow others, earlier and later ones, by multipliers of up
// to one and offsets of up to `offset` in magnitude.
void add_random_mimics(Random& random, RobotModel& robot, double offset);

// Positions of all its variables within +-`largest`.
std::vector<double> random_configuration(Random& random, const RobotModel& robot, double largest);

// Within the limits, half of them at places where boxes of proofs end: at halves, quarters, ...
// between them.
std::vector<double> random_in_ranges(Random& random, const RobotModel& robot);

}  // namespace spherule::test
