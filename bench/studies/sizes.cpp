// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/sphere_checkers.h"
#include "bench/scenes/work_cell.h"
#include "bench/studies/refined_cover.h"
#include "bench/studies/study.h"
#include "collide/collide.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"

#include <cmath>
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

namespace {

constexpr std::size_t kObstacles[] = {14, 30, 60, 100};
constexpr std::uint64_t kSeed = 4;
constexpr std::size_t kRandomConfigurations = 4000;
// Spheres of a body in the coarse robot: with eight bodies about as many as robots have in cuRobo's
// and VAMP's descriptions.
constexpr std::size_t kCoarseBody = 10;

// About the robot, as far out as it reaches, clear of it at the first configuration.
std::shared_ptr<const SphereTree> scattered(const Workload& workload, std::size_t count,
                                            RandomNumbers& random) {
  std::vector<Sphere> spheres;
  while (spheres.size() < count) {
    const double angle = random.between(-3.2, 3.2);
    const double distance = random.between(0.7, 2.5);
    const Sphere sphere{
        {distance * std::cos(angle), distance * std::sin(angle), random.between(0.0, 2.2)},
        random.between(0.05, 0.2)};
    Workload alone = workload;
    alone.obstacles = {{{.name = "ball",
                         .mesh = {},
                         .tree = std::make_shared<const SphereTree>(build_tree({&sphere, 1}))},
                        Pose()}};
    std::uint8_t hit = 0;
    make_tree_checker(alone, TreeMode::kSingle)->check({workload.program.data(), 1}, {&hit, 1});
    if (hit == 0) spheres.push_back(sphere);
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

std::vector<ArmPositions> random_configurations(const RobotModel& robot) {
  RandomNumbers random(kSeed);
  std::vector<ArmPositions> result(kRandomConfigurations);
  for (ArmPositions& configuration : result) {
    for (const Joint& joint : robot.joints()) {
      configuration[static_cast<std::size_t>(joint.variable)] =
          random.between(joint.lower, joint.upper);
    }
  }
  return result;
}

// Nothing but forward_kinematics().
class Kinematics : public SingleChecker {
 public:
  using SingleChecker::SingleChecker;

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    return world_from_link.back().translation().x() > kMaxCoordinate;
  }
};

SmallRow measure_row(const Workload& cell, const std::vector<ArmPositions>& configurations,
                     std::string order, int rounds) {
  std::vector<std::unique_ptr<Checker>> checkers;
  for (const TreeMode mode : {TreeMode::kSingle, TreeMode::kBatch, TreeMode::kPairs}) {
    checkers.push_back(make_tree_checker(cell, mode));
  }
  checkers.push_back(make_flat_scan_checker(cell, FlatScan::kSpheresInFront));
  checkers.push_back(std::make_unique<Kinematics>(cell.robot));
  const auto exact = verdicts_of(*checkers[2], configurations);
  const auto flat = verdicts_of(*checkers[3], configurations);
  const auto times = time_in_turns(checkers, configurations, rounds);
  SmallRow row;
  row.order = std::move(order);
  for (const Body& body : cell.bodies) row.robot_spheres += body.part.tree->spheres().size();
  row.obstacles = cell.obstacles.front().part.tree->spheres().size();
  row.single_ns = times[0];
  row.batch_ns = times[1];
  row.collides_ns = times[2];
  row.flat_scan_ns = times[3];
  row.kinematics_ns = times[4];
  std::size_t collisions = 0;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    collisions += exact[i];
    row.missed += exact[i] != 0 && flat[i] == 0 ? 1 : 0;
    row.extra += flat[i] != 0 && exact[i] == 0 ? 1 : 0;
  }
  row.collision_percent =
      100.0 * static_cast<double>(collisions) / static_cast<double>(configurations.size());
  return row;
}

}  // namespace

std::vector<SmallRow> study_small_environments(const Workload& workload,
                                               const StudyOptions& options) {
  Workload coarse = workload;
  for (Body& body : coarse.bodies) {
    body.part.tree =
        std::make_shared<const SphereTree>(build_tree(coarse_cover(*body.part.tree, kCoarseBody)));
  }
  std::vector<ArmPositions> path;
  for (std::size_t i = 0; i < workload.program.size(); i += options.stride) {
    path.push_back(workload.program[i]);
  }
  const auto random = random_configurations(workload.robot);
  RandomNumbers places(kSeed);
  std::vector<SmallRow> rows;
  for (const std::size_t count : kObstacles) {
    const auto spheres = scattered(coarse, count, places);
    for (const bool is_coarse : {true, false}) {
      Workload cell = is_coarse ? coarse : workload;
      cell.obstacles = {{{.name = "spheres", .mesh = {}, .tree = spheres}, Pose()}};
      rows.push_back(measure_row(cell, path, "path", options.rounds));
      rows.push_back(measure_row(cell, random, "random", options.rounds));
    }
  }
  return rows;
}

}  // namespace spherule
