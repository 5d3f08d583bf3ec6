// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/tree_checker.h"
#include "bench/scenes/program.h"
#include "bench/studies/refined_cover.h"
#include "bench/studies/study.h"
#include "bench/studies/turns.h"
#include "collide/collide.h"
#include "robot/model/kinematics.h"
#include "spheretree/build.h"

#include <memory>
#include <utility>

namespace spherule {
namespace {

constexpr std::size_t kFactors[] = {1, 4, 16, 100};
// How far a new sphere may stand out of the old one, as a part of E: without it, spheres at the rim
// of an old one would have to be as large as that.
constexpr double kSlack = 0.05;
constexpr std::size_t kCountedStride = 16;
constexpr std::uint64_t kShuffleSeed = 1;

Workload refined(const Workload& workload, std::size_t factor) {
  Workload result = workload;
  if (factor == 1) return result;
  const auto refine = [&](Part& part) {
    const std::size_t count = factor * part.tree->spheres().size();
    part.tree = std::make_shared<const SphereTree>(
        build_tree(refine_cover(part.mesh, part.tree->spheres(), count, kSlack * part.max_error)));
  };
  for (Body& body : result.bodies) refine(body.part);
  for (Obstacle& obstacle : result.obstacles) refine(obstacle.part);
  return result;
}

std::uint64_t node_tests(const Workload& workload, const std::vector<Pose>& world_from_link) {
  std::uint64_t tests = 0;
  for (const Body& body : workload.bodies) {
    for (const Obstacle& obstacle : workload.obstacles) {
      if (!is_tested(body, obstacle)) continue;
      const CollisionResult result =
          collide(*body.part.tree, world_from_link[static_cast<std::size_t>(body.link)],
                  *obstacle.part.tree, obstacle.world_from_part, {.max_pairs = 1});
      tests += result.cost.node_tests;
      if (result.verdict == Verdict::kCollision) return tests;
    }
  }
  return tests;
}

double mean_node_tests(const Workload& workload) {
  std::uint64_t tests = 0;
  std::size_t count = 0;
  std::vector<Pose> world_from_link;
  for (std::size_t i = 0; i < workload.program.size(); i += kCountedStride) {
    forward_kinematics(workload.robot, workload.program[i], world_from_link);
    tests += node_tests(workload, world_from_link);
    ++count;
  }
  return static_cast<double>(tests) / static_cast<double>(count);
}

}  // namespace

std::vector<SizeRow> study_sizes(const Workload& workload,
                                 const std::vector<std::uint32_t>& touching_bodies,
                                 const StudyOptions& options) {
  std::vector<SizeRow> rows;
  std::vector<std::unique_ptr<Checker>> single;
  std::vector<std::unique_ptr<Checker>> batch;
  for (const std::size_t factor : kFactors) {
    const Workload sized = refined(workload, factor);
    SizeRow row;
    row.factor = factor;
    row.spheres = sphere_count(sized);
    row.node_tests = mean_node_tests(sized);
    rows.push_back(row);
    single.push_back(make_tree_checker(sized, TreeMode::kSingle));
    batch.push_back(make_tree_checker(sized, TreeMode::kBatch));
  }
  std::vector<std::uint8_t> hit(workload.program.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto verdicts = verdicts_of(*single[i], workload.program);
    for (std::size_t k = 0; k < hit.size(); ++k) {
      rows[i].collisions += verdicts[k];
      rows[i].missed += touching_bodies[k] != 0 && verdicts[k] == 0 ? 1 : 0;
      hit[k] |= verdicts[k];
    }
  }
  std::vector<ArmPositions> path;
  std::vector<ArmPositions> free;
  for (std::size_t k = 0; k < hit.size(); k += options.stride) {
    path.push_back(workload.program[k]);
    if (hit[k] == 0) free.push_back(workload.program[k]);
  }
  const auto single_ns = time_in_turns(single, path, options.rounds);
  const auto shuffled_ns = time_in_turns(single, shuffled(path, kShuffleSeed), options.rounds);
  const auto batch_ns = time_in_turns(batch, path, options.rounds);
  const auto free_ns = time_in_turns(single, free, options.rounds);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].single_ns = single_ns[i];
    rows[i].shuffled_ns = shuffled_ns[i];
    rows[i].batch_ns = batch_ns[i];
    rows[i].free_ns = free_ns[i];
  }
  return rows;
}

}  // namespace spherule
