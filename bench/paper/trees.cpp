// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/trees.h"

#include "base/error.h"
#include "bench/baseline/hubbard_spheres.h"
#include "bench/baseline/medial_axis.h"
#include "bench/baseline/octree_spheres.h"
#include "bench/clock.h"
#include "bench/paper/figures.h"
#include "bench/studies/random_numbers.h"
#include "collide/collide.h"
#include "simplifier/simplify.h"
#include "spheretree/build.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace spherule {
namespace {

constexpr double kError = 0.004;  // of octree and rod
constexpr double kRodDiameter = 0.02;
constexpr double kRodLength = 0.15;
constexpr double kAround = 0.02;  // how far from the pipe's box the rod's middle may be
constexpr std::size_t kPoses = 4000;
constexpr int kRounds = 5;
constexpr std::uint64_t kSeed = 3;

std::vector<Pose> poses_near(const SphereTree& tree) {
  RandomNumbers random(kSeed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kPoses; ++i) {
    Eigen::Vector3d middle = tree.box().center;
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = tree.box().half_size[axis] + kAround;
      middle[axis] += random.between(-reach, reach);
    }
    poses.emplace_back(random.rotation(), middle);
  }
  return poses;
}

// Rounds alternate between the two trees.
void measure(const SphereTree& rod, const std::vector<Pose>& poses, const SphereTree& own,
             const SphereTree& ours, TreeRow& row) {
  const std::pair<const SphereTree*, TreeCost*> trees[] = {{&own, &row.own}, {&ours, &row.ours}};
  std::vector<bool> hits[2];
  for (int i = 0; i < 2; ++i) {
    const auto& [tree, cost] = trees[i];
    std::uint64_t tests = 0;
    for (const Pose& pose : poses) {
      const CollisionResult result = collide(rod, pose, *tree, Pose(), {.max_pairs = 1});
      tests += result.cost.node_tests;
      hits[i].push_back(!result.pairs.empty());
    }
    cost->nodes = tree->node_count();
    cost->depth = tree->depth();
    cost->node_tests = static_cast<double>(tests) / static_cast<double>(poses.size());
  }
  if (hits[0] != hits[1])
    throw Error(row.method, "two trees over the same spheres answer otherwise");
  row.collision_percent = 100.0 *
                          static_cast<double>(std::count(hits[0].begin(), hits[0].end(), true)) /
                          static_cast<double>(poses.size());
  std::vector<double> times[2];
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < 2; ++i) {
      const auto start = Clock::now();
      for (const Pose& pose : poses) collide(rod, pose, *trees[i].first, Pose(), {.max_pairs = 1});
      times[i].push_back(nanoseconds(Clock::now() - start) / static_cast<double>(poses.size()));
    }
  }
  for (int i = 0; i < 2; ++i) {
    std::sort(times[i].begin(), times[i].end());
    trees[i].second->ns = quantile(times[i], 0.5);
  }
}

}  // namespace

std::vector<TreeRow> study_trees() {
  const TriangleMesh pipe = make_paper_pipe();
  const Simplification rod_fit =
      simplify(make_cylinder(0.5 * kRodDiameter, kRodLength, 32), {.max_error = kError});
  const SphereTree rod = build_tree(rod_fit.cover.spheres);
  const SphereLevels hubbard = hubbard_spheres(pipe);
  const SphereLevels medial = medial_axis_tree(pipe);
  const std::pair<const char*, SphereTree> trees[] = {
      {"octree", octree_spheres(pipe, {.max_error = kError}).tree},
      {"hubbard", enclosing_tree(hubbard, hubbard.levels.back()).tree},
      {"medial-axis", enclosing_tree(medial, medial.levels.back()).tree}};
  std::vector<TreeRow> rows;
  for (const auto& [method, tree] : trees) {
    TreeRow row{.method = method, .leaves = tree.spheres().size()};
    measure(rod, poses_near(tree), tree, build_tree(tree.spheres()), row);
    rows.push_back(row);
  }
  return rows;
}

void print_trees(const std::vector<TreeRow>& rows) {
  std::printf(
      "\ntrees over the pipe, a rod nearby: as the method has them | ours, the same leaves\n");
  std::printf("%-12s %7s %6s %7s %6s %11s %8s | %7s %6s %11s %8s\n", "method", "leaves", "hit %",
              "nodes", "depth", "node tests", "ns", "nodes", "depth", "node tests", "ns");
  for (const TreeRow& row : rows) {
    std::printf("%-12s %7zu %6.1f %7zu %6d %11.1f %8.0f | %7zu %6d %11.1f %8.0f\n",
                row.method.c_str(), row.leaves, row.collision_percent, row.own.nodes, row.own.depth,
                row.own.node_tests, row.own.ns, row.ours.nodes, row.ours.depth, row.ours.node_tests,
                row.ours.ns);
  }
}

}  // namespace spherule
