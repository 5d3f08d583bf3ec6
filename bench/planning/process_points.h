// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "geometry/pose.h"

#include <cstddef>
#include <vector>

namespace spherule {

// The first part of the paper's planning: for points along the three seams of the pipes, with the
// wire's end a few millimetres off the metal, every turn of the torch about the wire and every
// posture of the robot is examined.
struct ProcessPoints {
  std::size_t points = 0;
  std::size_t angles = 0;
  std::size_t postures = 0;  // of all points and angles, those beyond the joint limits included
  // Those within the limits, on the grid of on_joint_grid(), point by point and angle by angle.
  std::vector<ArmPositions> configurations = {};
  std::vector<std::size_t> point_of = {};  // of each configuration
};

// Always the same. Throws Error if forward_kinematics() does not bring the wire's end of a
// configuration to within 10 micrometres of its place.
ProcessPoints make_process_points(const RobotModel& robot, const Pose& flange_from_wire,
                                  std::size_t points, std::size_t angles);

}  // namespace spherule
