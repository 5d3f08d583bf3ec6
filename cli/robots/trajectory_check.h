// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"
#include "cli/robots/check_report.h"
#include "robot/check/robot_checker.h"
#include "robot/files/trajectory_file.h"

#include <cstddef>
#include <vector>

namespace spherule {

struct TrajectoryCheckOptions {
  // In so many of the first configurations pairs that only proofs keep apart are counted, too.
  std::size_t explained = 0;
  int threads = 0;
  Progress progress{};
  EdgeRequest edge{};  // of motions
  // Of all parts of a trajectory together; 0: of what is given. How many places of a motion are
  // searched for contacts deeper than its first depends on it alone, so that each part finds what
  // the whole does.
  std::size_t configurations_in_all = 0;
};

// One for each thread: `threads` of them, or for 0 as many as the machine runs at once.
std::vector<RobotChecker::Scratch> make_scratches(const RobotChecker& checker, int threads);

// Every configuration, or every motion from one to the next.
TrajectoryFindings check_configurations(const RobotChecker& checker, const Trajectory& trajectory,
                                        const TrajectoryCheckOptions& options);
TrajectoryFindings check_motions(const RobotChecker& checker, const Trajectory& trajectory,
                                 const TrajectoryCheckOptions& options);

}  // namespace spherule
