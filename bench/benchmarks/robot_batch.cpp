// SPDX-License-Identifier: BSD-3-Clause
// What does a configuration of a batch cost, over how many threads? The weld program of the work
// cell, in its order and in a random one, of which the first so many configurations are requested.
// The spheres are those around the triangles, cut small: more than fitted ones, and there at once.
// Counters: time a configuration (of the clock on the wall), the share that collides, spheres.

#include "bench/checkers/sphere_checkers.h"
#include "bench/checkers/workload.h"
#include "bench/scenes/work_cell.h"
#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace spherule {
namespace {

// Around the triangles, halved across their longest edge until no sphere is larger than `radius`.
std::shared_ptr<const SphereTree> spheres_around(const TriangleMesh& mesh, double radius) {
  using Corners = std::array<Eigen::Vector3d, 3>;
  std::vector<Corners> open;
  for (const Eigen::Vector3i& t : mesh.triangles) open.push_back(corners_of(mesh, t));
  std::vector<Sphere> spheres;
  while (!open.empty()) {
    Corners corners = open.back();
    open.pop_back();
    const Sphere sphere = enclosing_sphere(corners);
    if (sphere.radius <= radius) {
      spheres.push_back(
          {sphere.center, sphere.radius * (1.0 + 1e-9)});  // for the rounding of the cuts
      continue;
    }
    const auto length = [&](std::size_t k) { return (corners[(k + 1) % 3] - corners[k]).norm(); };
    std::size_t longest = 0;
    for (const std::size_t k : {1, 2}) longest = length(k) > length(longest) ? k : longest;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(longest),
                corners.end());
    const Eigen::Vector3d middle = 0.5 * (corners[0] + corners[1]);
    open.push_back({corners[0], middle, corners[2]});
    open.push_back({middle, corners[1], corners[2]});
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

constexpr double kLeastRadius = 5e-3;

struct Cell {
  Cell() : workload(make_paper_cell()), jumps(shuffled(workload.program, 1)) {
    const auto cover = [&](Part& part) {
      part.tree = spheres_around(part.mesh, std::max(part.max_error, kLeastRadius));
      spheres += part.tree->spheres().size();
    };
    for (Body& body : workload.bodies) cover(body.part);
    for (Obstacle& obstacle : workload.obstacles) cover(obstacle.part);
  }

  Workload workload;
  std::vector<ArmPositions> jumps;
  std::size_t spheres = 0;
};

const Cell& cell() {
  static const Cell kCell;
  return kCell;
}

void run(benchmark::State& state, const RobotChecker& checker,
         const std::vector<ArmPositions>& program) {
  const auto count = static_cast<std::size_t>(state.range(0));
  std::vector<RobotChecker::Scratch> scratches;
  for (int i = 0; i < state.range(1); ++i) scratches.emplace_back(checker);
  std::vector<std::uint8_t> free(count);
  const std::span<const double> configurations(program.front().data(), count * kJoints);
  for (auto _ : state) {
    checker.check_configs(configurations, scratches, free);
    benchmark::DoNotOptimize(free.data());
    benchmark::ClobberMemory();
  }
  using benchmark::Counter;
  state.counters["each"] =
      Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["colliding"] =
      static_cast<double>(std::count(free.begin(), free.end(), 0)) / static_cast<double>(count);
  state.counters["spheres"] = static_cast<double>(cell().spheres);
}

void BM_AlongThePath(benchmark::State& state) {
  run(state, make_robot_checker(cell().workload), cell().workload.program);
}
void BM_InRandomOrder(benchmark::State& state) {
  run(state, make_robot_checker(cell().workload), cell().jumps);
}
// Contacts confirmed on the triangles.
void BM_ConfirmedAlongThePath(benchmark::State& state) {
  run(state, make_robot_checker(cell().workload, best_instruction_set(), UsedMeshes::kAll),
      cell().workload.program);
}

// Moves from one configuration of the program to the next, one per call.
void BM_MovesAlongThePath(benchmark::State& state) {
  const RobotChecker checker = make_robot_checker(cell().workload);
  RobotChecker::Scratch scratch(checker);
  const std::vector<ArmPositions>& program = cell().workload.program;
  std::size_t free = 0;
  std::size_t moves = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i + 1 < program.size(); ++i) {
      free += checker.check_edge(program[i], program[i + 1], scratch).verdict == Verdict::kFree;
    }
    moves += program.size() - 1;
  }
  using benchmark::Counter;
  state.counters["each"] = Counter(static_cast<double>(moves), Counter::kIsRate | Counter::kInvert);
  state.counters["free"] = static_cast<double>(free) / static_cast<double>(moves);
}

// Configurations; threads.
void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgsProduct({{256, 1024, static_cast<std::int64_t>(kProgramSize)}, {1, 2}})
      ->UseRealTime()
      ->Unit(benchmark::kMicrosecond);
}
BENCHMARK(BM_AlongThePath)->Apply(sizes);
BENCHMARK(BM_InRandomOrder)->Apply(sizes);
BENCHMARK(BM_ConfirmedAlongThePath)->Apply(sizes);
BENCHMARK(BM_MovesAlongThePath)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spherule
