// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/planning/problems.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

namespace spherule {

// What tells a planner whether states and motions are valid.
enum class Validity {
  kProved,   // RobotChecker, motions proved free at every point
  kSampled,  // RobotChecker, at steps of the motion
  kMeshes,   // FCL on the meshes, at steps, too
};
std::string name_of(Validity validity);

// Both engines answer for the same cell. `checker` is used for the first two, `meshes` for the
// third.
struct PlanningEngines {
  const RobotChecker& checker;
  ContactTest meshes;
};

struct PlanOptions {
  std::uint32_t seed = 1;                // of the samples, whatever judges them
  double step = 0.01;                    // of sampled motions, see make_joint_space()
  std::uint64_t most_iterations = 5000;  // of the planner
  double most_seconds = 10.0;            // of the processor
};

enum class PlanEnd { kSolved, kEndsRefused, kIterations, kSeconds };

struct Plan {
  PlanEnd end = PlanEnd::kEndsRefused;  // start or goal is not valid
  double seconds = 0.0;                 // of the processor, of the search alone
  std::size_t state_checks = 0;         // configurations requested singly
  std::size_t motion_checks = 0;
  std::vector<Configuration> path = {};  // from start to goal if it is solved, otherwise empty

  bool is_solved() const { return end == PlanEnd::kSolved; }
};

// RRTConnect as OMPL sets it up by itself.
Plan plan(const PlanningEngines& engines, Validity validity, const PlanningProblem& problem,
          const PlanOptions& options = {});

// Of this process so far, in ticks of a microsecond: what is timed by it runs on one thread, and
// what else the machine does hardly shows.
inline double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace spherule
