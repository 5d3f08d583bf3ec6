// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm_problems.h"

#include "base/error.h"
#include "bench/robot_edges/arm.h"

#include <utility>

namespace spherule {
namespace {

constexpr int kTries = 5000;  // for one problem

}  // namespace

std::vector<PlanningProblem> make_arm_problems(const RobotChecker& checker, FclArm& fcl,
                                               std::size_t count, RandomNumbers& random) {
  RobotChecker::Scratch scratch(checker);
  const auto is_end = [&](const Configuration& at) {
    return checker.check_config(at, scratch) && !fcl.holds_an_obstacle(at);
  };
  const ContactTest in_contact = [&](std::span<const double> at) { return fcl.collides(at); };
  std::vector<PlanningProblem> problems;
  for (int tries = 0; problems.size() < count; ++tries) {
    if (tries == kTries) throw Error("problems", "hardly any motion needs a plan");
    PlanningProblem problem{random_configuration(checker.robot(), random),
                            random_configuration(checker.robot(), random)};
    if (!is_end(problem.start) || !is_end(problem.goal)) continue;
    if (!needs_a_plan(problem, in_contact)) continue;
    problems.push_back(std::move(problem));
    tries = 0;
  }
  return problems;
}

}  // namespace spherule
