// SPDX-License-Identifier: BSD-3-Clause

// How long do build_tree and refit take, and how good is the tree? Spheres scattered through a cube
// (solid) or over a sphere (shell), as a cover of a solid part and of a thin wall would have them.
// Counters: nodes, depth, radius of the root, growth (radius over that of the largest child, mean)
// and overlap (spheres that hold the centre of a sphere, to those that must, above its leaf).

#include "spheretree/sphere_tree.h"
#include "tests/support/random.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace {

using Eigen::Vector3d;
using spherule::Sphere;
using spherule::SphereTree;
using spherule::test::Random;

// Radii of about the mean distance of neighbours, so that neighbours overlap.
std::vector<Sphere> solid(std::size_t count) {
  Random random(1);
  const double radius = std::cbrt(8.0 / static_cast<double>(count));
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) spheres.push_back({random.point(1.0), radius});
  return spheres;
}

std::vector<Sphere> shell(std::size_t count) {
  Random random(2);
  const double radius = std::sqrt(4.0 * 3.14 / static_cast<double>(count));
  std::vector<Sphere> spheres;
  while (spheres.size() < count) {
    const Vector3d point = random.point(1.0);
    const double length = point.norm();
    if (length > 0.1 && length < 1.0) spheres.push_back({point / length, radius});
  }
  return spheres;
}

// One sphere in `share` moved by up to 0.3 of its radius along each axis.
std::vector<Sphere> stirred(std::vector<Sphere> spheres, std::size_t share) {
  Random random(3);
  for (Sphere& sphere : spheres) {
    if (random.index(share) == 0) sphere.center += 0.3 * sphere.radius * random.point(1.0);
  }
  return spheres;
}

double overlap(const SphereTree& tree) {
  const std::size_t stride = tree.spheres().size() / 1000;
  double holding = 0.0;
  double needed = 0.0;
  std::vector<std::pair<std::size_t, int>> open;  // node, its distance from the root
  for (std::size_t index = 0; index < tree.spheres().size(); index += stride) {
    const Vector3d center = tree.spheres()[index].center;
    open.emplace_back(0, 0);
    while (!open.empty()) {
      const auto [node, depth] = open.back();
      open.pop_back();
      if (tree.is_leaf(node)) {
        if (static_cast<std::size_t>(tree.sphere_index(node)) == index) needed += depth;
        continue;
      }
      const Sphere sphere = tree.sphere(node);
      if ((sphere.center - center).norm() > sphere.radius) continue;
      holding += 1.0;
      for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
        open.emplace_back(static_cast<std::size_t>(tree.first_child(node) + i), depth + 1);
      }
    }
  }
  return holding / needed;
}

void count(benchmark::State& state, const SphereTree& tree) {
  const spherule::TreeReport report = spherule::check(tree);
  state.counters["nodes"] = static_cast<double>(report.node_count);
  state.counters["depth"] = report.depth;
  state.counters["root_radius"] = report.root_radius;
  state.counters["growth"] = report.mean_inflation;
  state.counters["overlap"] = overlap(tree);
  state.counters["spheres/s"] = benchmark::Counter(static_cast<double>(report.sphere_count),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

void BM_BuildTree(benchmark::State& state, std::vector<Sphere> (*make)(std::size_t)) {
  const std::vector<Sphere> spheres = make(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(spherule::build_tree(spheres));
  count(state, spherule::build_tree(spheres));
}

// Back and forth, so that every round moves as many.
void BM_Refit(benchmark::State& state, std::vector<Sphere> (*make)(std::size_t)) {
  const std::vector<Sphere> spheres = make(static_cast<std::size_t>(state.range(0)));
  const std::vector<Sphere> moved = stirred(spheres, static_cast<std::size_t>(state.range(1)));
  SphereTree tree = spherule::build_tree(spheres);
  bool there = false;
  for (auto _ : state) {
    there = !there;
    tree = spherule::refit(std::move(tree), there ? moved : spheres);
  }
  count(state, spherule::refit(std::move(tree), moved));
}

BENCHMARK_CAPTURE(BM_BuildTree, solid, solid)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_BuildTree, shell, shell)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMillisecond);
// Spheres; one in how many moves.
BENCHMARK_CAPTURE(BM_Refit, solid, solid)
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {1, 100}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Refit, shell, shell)
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {1, 100}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
