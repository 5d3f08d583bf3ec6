// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/studies/measure.h"
#include "geometry/pose.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <string>
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

struct ProcessRow {
  std::string engine;
  double checks_a_second = 0.0;
  VerdictCount count = {};      // against the oracle of the solids
  std::size_t free_points = 0;  // with a posture that the engine finds free
  std::size_t lost_points = 0;  // free for the oracle, and for the engine in no posture
};

struct ProcessStudy {
  std::size_t points = 0;
  std::size_t angles = 0;
  std::size_t postures = 0;
  std::size_t configurations = 0;
  std::size_t free_configurations = 0;  // for the oracle
  std::size_t free_points = 0;          // for the oracle
  std::vector<ProcessRow> rows = {};    // ours in single calls and in batches, FCL twice
};

// Checks all postures in their order with every engine; of some runs the fastest counts, in
// processor time.
ProcessStudy study_process_points(const Workload& workload, const RobotChecker& checker,
                                  const ProcessPoints& points);

}  // namespace spherule
