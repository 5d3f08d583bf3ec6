// SPDX-License-Identifier: BSD-3-Clause

// How long does build_tree take, and how good is the tree? Spheres scattered through a cube (solid)
// or over a sphere (shell), as a cover of a solid part and of a thin wall would have them.

#include "spheretree/build.h"
#include "spheretree/check.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace {

using Eigen::Vector3d;
using spherule::Sphere;

Vector3d point_in_cube(std::mt19937_64& random) {
  const auto coordinate = [&random] {
    return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0;
  };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

// Radii of about the mean distance of neighbours, so that neighbours overlap.
std::vector<Sphere> solid(std::size_t count) {
  std::mt19937_64 random(1);
  const double radius = std::cbrt(8.0 / static_cast<double>(count));
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) spheres.push_back({point_in_cube(random), radius});
  return spheres;
}

std::vector<Sphere> shell(std::size_t count) {
  std::mt19937_64 random(2);
  const double radius = std::sqrt(4.0 * 3.14 / static_cast<double>(count));
  std::vector<Sphere> spheres;
  while (spheres.size() < count) {
    const Vector3d point = point_in_cube(random);
    const double length = point.norm();
    if (length > 0.1 && length < 1.0) spheres.push_back({point / length, radius});
  }
  return spheres;
}

void BM_BuildTree(benchmark::State& state, std::vector<Sphere> (*make)(std::size_t)) {
  const std::vector<Sphere> spheres = make(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(spherule::build_tree(spheres));
  const spherule::TreeReport report = spherule::check(spherule::build_tree(spheres));
  state.counters["nodes"] = static_cast<double>(report.node_count);
  state.counters["depth"] = report.depth;
  state.counters["root_radius"] = report.root_radius;
  state.counters["spheres/s"] = benchmark::Counter(static_cast<double>(state.range(0)),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(BM_BuildTree, solid, solid)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_BuildTree, shell, shell)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
