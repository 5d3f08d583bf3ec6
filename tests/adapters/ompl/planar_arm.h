// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_checker.h"

#include <span>

namespace spherule::test {

// Three links of 0.5 m in the plane, turning about z, the first without limits, made of spheres of
// 0.05 m, and a wall of spheres along x that leaves it a gap at its base. Links meet each other
// only where a joint is turned beyond +-1.5.
inline constexpr int kArmJoints = 3;
RobotChecker planar_arm();

// The smallest gap between any sphere of the arm and of the wall, by trigonometry; below zero where
// they overlap.
double planar_arm_gap(std::span<const double> configuration);

}  // namespace spherule::test
