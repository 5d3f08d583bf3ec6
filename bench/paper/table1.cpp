// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/checkers/workload.h"
#include "bench/paper/figures.h"
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"
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

// Of the chosen queries.
Table1Cells cells(const std::vector<std::uint8_t>& verdicts, const std::vector<std::uint8_t>& truth,
                  double ns_per_query) {
  return {.queries = truth.size(),
          .count = count(verdicts, truth),
          .seconds = 1e-9 * ns_per_query * static_cast<double>(truth.size())};
}

}  // namespace

std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options) {
  const auto touching = Oracle(workload).touching_bodies(workload.program);
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t bodies : touching) truth.push_back(bodies != 0 ? 1 : 0);
  std::vector<ArmPositions> critical;
  std::vector<std::uint8_t> critical_truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (workload.is_critical[i] == 0) continue;
    critical.push_back(workload.program[i]);
    critical_truth.push_back(truth[i]);
  }
  std::vector<Table1Row> rows;
  std::vector<Method> methods;
  for (Representation& of : representations) {
    rows.push_back({of.method, of.complexity, of.is_conservative, {}, {}, of.paper});
    methods.push_back({of.method, of.complexity, std::move(of.checker), 0, false});
  }
  const std::vector<Measurement> whole = measure(methods, workload.program, options);
  const std::vector<Measurement> of_critical = measure(methods, critical, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].whole = cells(whole[i].verdicts, truth, whole[i].ns_per_query);
    rows[i].critical = cells(of_critical[i].verdicts, critical_truth, of_critical[i].ns_per_query);
    rows[i].whole.ratio = rows.front().whole.seconds / rows[i].whole.seconds;
    rows[i].critical.ratio = rows.front().critical.seconds / rows[i].critical.seconds;
  }
  return rows;
}

void print_table1(const std::vector<Table1Row>& rows) {
  std::printf("\nTable I (in brackets: the critical section; at the right: the paper's row)\n");
  std::printf("%-16s %-16s %16s %14s %14s %20s %18s | %-16s %6s %8s %6s\n", "method", "complexity",
              "collisions", "missed", "extra", "ms", "ratio", "paper", "coll.", "s", "ratio");
  for (const Table1Row& row : rows) {
    std::printf("%-16s %-16s %7zu (%6zu) %5zu (%5zu) %5zu (%5zu) %9.3f (%8.3f) %8.1f (%6.1f) |",
                row.method.c_str(), row.complexity.c_str(), row.whole.count.collisions,
                row.critical.count.collisions, row.whole.count.missed, row.critical.count.missed,
                row.whole.count.extra, row.critical.count.extra, 1e3 * row.whole.seconds,
                1e3 * row.critical.seconds, row.whole.ratio, row.critical.ratio);
    if (row.paper) {
      std::printf(" %-16s %6zu %8.0f %6.1f", row.paper->complexity.c_str(), row.paper->collisions,
                  row.paper->seconds, rows.front().paper->seconds / row.paper->seconds);
    }
    std::printf("\n");
  }
}

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
  for (int i = 0; i < 2; ++i) trees[i].second->ns = median(times[i]);
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
