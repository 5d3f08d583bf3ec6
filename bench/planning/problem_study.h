// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/planning/planner.h"

#include <cstddef>
#include <vector>

namespace spherule {

// A way of checking, over all problems.
struct ProblemRow {
  Validity validity = Validity::kProved;
  std::vector<Plan> plans = {};            // of each problem
  std::vector<std::size_t> contacts = {};  // on each path, for FCL on the meshes in double
  std::size_t tested = 0;                  // configurations of all paths, for these contacts

  std::size_t ended(PlanEnd end) const;
  std::size_t paths_in_contact() const;
};

// How a row compares with another one, FCL's.
struct ProblemComparison {
  std::size_t both = 0;         // problems that both solve
  std::size_t mesh_only = 0;    // that FCL solves and it does not
  std::size_t refused = 0;      // of these, those whose start or goal it does not find free
  std::size_t sphere_only = 0;  // the reverse
  double median_ratio = 0.0;    // of the times of a problem that both solve
  double total_ratio = 0.0;     // of the sums of these times
};

struct ProblemStudy {
  PlanOptions options = {};
  double recheck_step = 0.0;
  std::vector<ProblemRow> rows = {};  // proved, sampled, FCL

  // What was found for other problems.
  void add(const ProblemStudy& other);
};

// Plans all problems with each way of checking, the same seed for the same problem, and examines
// every path again by `judge` at steps of `recheck_step` radians (check_path()).
ProblemStudy study_problems(const PlanningEngines& engines, const ContactTest& judge,
                            const std::vector<PlanningProblem>& problems,
                            const PlanOptions& options, double recheck_step);

// The same in a cell, by FCL's fastest setting and, looking again, in double.
ProblemStudy study_problems(const Workload& workload, const RobotChecker& checker,
                            const std::vector<PlanningProblem>& problems,
                            const PlanOptions& options, double recheck_step);

ProblemComparison compare(const ProblemRow& row, const ProblemRow& meshes);

// Milliseconds of the solved ones.
double median_milliseconds(const ProblemRow& row);

struct PathCheck {
  std::size_t configurations = 0;  // examined
  std::size_t contacts = 0;        // of these, in contact
};

// Queries an engine about configurations on a path of straight motions in joint space, its corners
// included, no joint moving by more than `step` radians from one to the next.
PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step);

}  // namespace spherule
