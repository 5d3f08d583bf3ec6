// SPDX-License-Identifier: BSD-3-Clause
// Does a planner gain by spheres, and does it lose solutions? And how many process points are
// judged a second? In the paper's work cell; see bench/README.md.
//   spherule_planning [--out DIR] [--effort N] [--problems N]
#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/planning/arguments.h"
#include "bench/planning/problems.h"
#include "bench/planning/report.h"
#include "bench/scenes/work_cell_parts.h"
#include "bench/studies/fit_parts.h"
#include "bench/studies/measure.h"

#include <cstdio>

namespace spherule {
namespace {

constexpr double kRecheckStep = 0.001;  // radians
constexpr std::size_t kPoints = 500;
constexpr std::size_t kAngles = 36;

class Phases {
 public:
  void end(const char* phase) {
    const auto now = Clock::now();
    std::printf("%s: %.1f s\n", phase, 1e-9 * nanoseconds(now - start_));
    std::fflush(stdout);
    start_ = now;
  }

 private:
  Clock::time_point start_ = Clock::now();
};

void run(const PlanningArguments& arguments) {
  Phases phases;
  Workload cell = make_paper_cell();
  PlanningResult result{.name = cell.name};
  result.fits = fit_parts(cell, &print_fit, arguments.effort);
  const RobotChecker checker = make_robot_checker(cell);
  phases.end("fits");

  const ProcessPoints points =
      make_process_points(cell.robot, flange_from_wire(), kPoints, kAngles);
  result.process = study_process_points(cell, checker, points);
  print_table(result.process);
  phases.end("process points");

  const auto problems = make_problems(cell, *make_fcl_mesh_checker(cell, {}), points.configurations,
                                      arguments.problems);
  result.problems = study_problems(cell, checker, problems, {}, kRecheckStep);
  print_table(result.problems);
  phases.end("problems");

  write_result(result, arguments.out);
  if (result.problems.rows.front().paths_in_contact() > 0) {
    throw Error(result.name, "a path that was proved free is in contact");
  }
  for (const ProcessRow& row : result.process.rows) {
    if (row.engine.starts_with("spherule") && row.count.missed > 0) {
      throw Error(result.name, row.engine + " missed collisions");
    }
  }
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_planning_program("spherule_planning", count, values, true, &spherule::run);
}
