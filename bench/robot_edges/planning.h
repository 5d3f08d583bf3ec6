// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Motions of an arm planned by OMPL, with each way of checking states and motions.

#include "bench/checkers/workload.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/refined_cover.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule {

struct PlanningProblem {
  Configuration start;
  Configuration goal;
};

// What tells a planner whether states and motions are valid.
enum class Validity {
  kProved,   // RobotChecker, motions proved free at every point
  kSampled,  // RobotChecker, at steps of the motion
  kMeshes,   // FCL on the meshes, at steps, too
};

// Both engines answer for the same cell. `checker` is used for the first two, `meshes` for the
// third.
struct PlanningEngines {
  const RobotChecker& checker;
  ContactTest meshes;
};

struct PlanOptions {
  std::uint32_t seed = 1;                // of the samples, whatever judges them
  double step = 0.01;                    // of sampled motions (length of the vector of positions)
  std::uint64_t most_iterations = 5000;  // of the planner
  double most_seconds = 10.0;            // of the processor
};

struct Plan {
  double seconds = 0.0;                  // of the processor, of the search alone
  std::vector<Configuration> path = {};  // from start to goal; empty if none was found

  bool is_solved() const { return !path.empty(); }
};

// RRTConnect as OMPL sets it up by itself. No path where start or goal is not valid.
Plan plan(const PlanningEngines& engines, Validity validity, const PlanningProblem& problem,
          const PlanOptions& options = {});

struct PathCheck {
  std::size_t configurations = 0;  // examined
  std::size_t contacts = 0;        // of these, in contact
};

// Queries an engine about configurations on a path of straight motions in joint space, its corners
// included, no joint moving by more than `step` radians from one to the next.
PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step);

// So many motions to plan, between configurations drawn within the limits of the joints: the ends
// are free for both, no obstacle is inside of a link there, and FCL finds the straight motion
// between them in contact. Throws Error if hardly any two ends are so.
std::vector<PlanningProblem> make_arm_problems(const RobotChecker& checker, FclArm& fcl,
                                               std::size_t count, RandomNumbers& random);

// A way of checking, over all problems.
struct ProblemRow {
  Validity validity = Validity::kProved;
  std::vector<Plan> plans = {};  // of each problem
  std::size_t solved = 0;
  std::size_t in_contact = 0;  // paths, as examined again

  double median_milliseconds() const;  // of the solved ones
};

// Times of another row over those of this one, for the problems that both solve.
struct TimeRatios {
  double median = 0.0;
  double of_sums = 0.0;
};
TimeRatios compare(const ProblemRow& row, const ProblemRow& other);

// Plans all problems with each way of checking (proved, sampled, FCL), the same seed for the same
// problem, and examines every path again by `judge` at steps of `recheck_step` radians
// (check_path()).
std::vector<ProblemRow> study_problems(const PlanningEngines& engines, const ContactTest& judge,
                                       const std::vector<PlanningProblem>& problems,
                                       const PlanOptions& options, double recheck_step);

// The rows of further problems, at the end of each row.
void append(std::vector<ProblemRow>& rows, const std::vector<ProblemRow>& more);

}  // namespace spherule
