// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/measure.h"
#include "bench/planning/process_points.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spherule {

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
