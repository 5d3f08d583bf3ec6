// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/problems.h"

#include "base/error.h"
#include "bench/planning/problem_study.h"
#include "bench/studies/refined_cover.h"

#include <algorithm>
#include <cstdint>

namespace spherule {

bool collides(Checker& checker, const ArmPositions& positions) {
  std::uint8_t verdict = 0;
  checker.check({&positions, 1}, {&verdict, 1});
  return verdict != 0;
}

ContactTest contact_test(Checker& checker) {
  return [&checker](std::span<const double> configuration) {
    ArmPositions positions;
    std::copy_n(configuration.begin(), kJoints, positions.begin());
    return collides(checker, positions);
  };
}

namespace {

constexpr std::uint64_t kSeed = 11;
constexpr int kTries = 1000;    // for one problem
constexpr double kStep = 0.01;  // radians

Configuration configuration_of(const ArmPositions& positions) {
  return {positions.begin(), positions.end()};
}

}  // namespace

bool needs_a_plan(const PlanningProblem& problem, const ContactTest& in_contact) {
  return !in_contact(problem.start) && !in_contact(problem.goal) &&
         check_path({problem.start, problem.goal}, in_contact, kStep).contacts > 0;
}

std::vector<PlanningProblem> make_problems(const Workload& workload, Checker& meshes,
                                           std::span<const ArmPositions> places,
                                           std::size_t count) {
  if (places.empty()) throw Error(workload.name, "there is no place to start from");
  RandomNumbers random(kSeed);
  const auto place = [&] {
    const double drawn = random.between(0.0, static_cast<double>(places.size()));
    return places[std::min(places.size() - 1, static_cast<std::size_t>(drawn))];
  };
  std::vector<PlanningProblem> problems;
  for (int tries = 0; problems.size() < count; ++tries) {
    if (tries == kTries) throw Error(workload.name, "hardly any motion needs a plan");
    const ArmPositions start = place();
    const bool goes_home = problems.size() % 2 == 0;
    const PlanningProblem problem{configuration_of(start),
                                  configuration_of(goes_home ? workload.program.front() : place())};
    if (!needs_a_plan(problem, contact_test(meshes))) continue;
    problems.push_back(problem);
    tries = 0;
  }
  return problems;
}

}  // namespace spherule
