// SPDX-License-Identifier: BSD-3-Clause
// An example: a motion of the IRB 4400 with its weld torch, from a seam of the pipes to the home
// position, planned by OMPL with motions that are proved free, and examined again by FCL on the
// meshes. In the cell of bench/scenes, or with the real robot and torch where SPHERULE_MODELS names
// a folder of models.
//   spherule_plan_motion [--out DIR] [--effort N]
#include "base/error.h"
#include "base/files.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/planning/arguments.h"
#include "bench/planning/planner.h"
#include "bench/planning/problem_study.h"
#include "bench/planning/problems.h"
#include "bench/planning/process_study.h"
#include "bench/report.h"
#include "bench/scenes/work_cell_parts.h"
#include "bench/studies/fit_parts.h"
#include "tests/support/program.h"

#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

namespace spherule {
namespace {

constexpr double kRecheckStep = 1e-4;  // radians: about a quarter of a millimetre at full reach

// Places at the seams to draw the start from.
constexpr std::size_t kPoints = 60;
constexpr std::size_t kAngles = 12;

// A configuration a line, in radians, as `spherule check` reads them.
void write_path(const std::vector<Configuration>& path, const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (const Configuration& positions : path) {
    for (std::size_t i = 0; i < positions.size(); ++i) text << (i == 0 ? "" : ",") << positions[i];
    text << '\n';
  }
  write_file_atomically(file, text.str());
}

struct Example {
  Workload cell;
  Pose flange_from_wire;
};

Example make_example() {
  const std::optional<std::filesystem::path> models = models_folder();
  if (!models) return {make_paper_cell(), flange_from_wire()};
  return {make_real_cell(*models), real_flange_from_wire(*models)};
}

void run(const PlanningArguments& arguments) {
  auto [cell, flange_from_wire] = make_example();
  std::printf("%s: fitting\n", cell.name.c_str());
  fit_parts(cell, &print_fit, arguments.effort);
  const RobotChecker checker = make_robot_checker(cell);
  const auto meshes = make_fcl_mesh_checker(cell, {});
  const auto places = make_process_points(cell.robot, flange_from_wire, kPoints, kAngles);
  // The first of them ends at home.
  const PlanningProblem problem = make_problems(cell, *meshes, places.configurations, 1).front();
  const Plan found = plan({checker, contact_test(*meshes)}, Validity::kProved, problem);
  if (!found.is_solved()) throw Error(cell.name, "no motion was found");
  const auto file = arguments.out / "motion.csv";
  write_path(found.path, file);
  const PathCheck again = check_path(found.path, contact_test(*meshes), kRecheckStep);
  std::printf(
      "from a seam to home in %.2f ms (%zu motions proved or refused), %zu configurations: %s\n"
      "FCL on the meshes at %zu configurations of it: %zu in contact\n",
      1e3 * found.seconds, found.motion_checks, found.path.size(), file.c_str(),
      again.configurations, again.contacts);
  if (again.contacts > 0) throw Error(cell.name, "the path is in contact");
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_planning_program("spherule_plan_motion", count, values, false,
                                        &spherule::run);
}
