// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/problems.h"

#include "bench/planning/planning_cell.h"
#include "bench/scenes/program.h"
#include "bench/studies/random_numbers.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cstdint>

namespace spherule {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr int kTries = 1000;  // for one place that is free

}  // namespace

std::vector<PlanningProblem> make_problems(const Workload& workload, Checker& meshes,
                                           std::span<const ArmPositions> places,
                                           std::size_t count) {
  const ArmPositions& home = workload.program.front();
  if (collides(meshes, home) || collides(meshes, kStation)) {
    throw Error(workload.name, "the home position or the station is in contact");
  }
  RandomNumbers random(kSeed);
  const auto free_place = [&] {
    for (int i = 0; i < kTries && !places.empty(); ++i) {
      const double drawn = random.between(0.0, static_cast<double>(places.size()));
      const ArmPositions& place =
          places[std::min(places.size() - 1, static_cast<std::size_t>(drawn))];
      if (!collides(meshes, place)) return place;
    }
    throw Error(workload.name, "no place to start from is free");
  };
  std::vector<PlanningProblem> problems;
  for (std::size_t i = 0; i < count; ++i) {
    const ArmPositions start = free_place();
    problems.push_back({start, i % 3 == 0 ? home : i % 3 == 1 ? kStation : free_place()});
  }
  return problems;
}

std::vector<ArmPositions> places_at_metal(const Workload& workload) {
  std::vector<ArmPositions> places;
  for (std::size_t i = 0; i < workload.program.size(); ++i) {
    if (workload.is_critical[i] != 0) places.push_back(workload.program[i]);
  }
  return places;
}

}  // namespace spherule
