// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/sphere_checkers.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

double scene_reach(const Workload& workload) {
  std::vector<double> along(workload.robot.links().size(), 0.0);
  for (std::size_t i = 0; i < along.size(); ++i) {
    const Link& link = workload.robot.links()[i];
    if (link.parent_joint < 0) continue;
    const Joint& joint = workload.robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    along[i] = along[static_cast<std::size_t>(joint.parent_link)] +
               joint.parent_from_joint.translation().norm();
  }
  double reach = 0.0;
  for (const Body& body : workload.bodies) {
    reach = std::max(reach, along[static_cast<std::size_t>(body.link)] + body.part.tree->reach());
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    reach = std::max(reach,
                     obstacle.world_from_part.translation().norm() + obstacle.part.tree->reach());
  }
  return reach;
}

double single_precision_pad(double reach) {
  return 64.0 * 0x1p-24 * reach;
}

namespace {

class TreeChecker : public Checker {
 public:
  TreeChecker(RobotChecker checker, bool in_batches)
      : checker_(std::move(checker)), scratch_(checker_), in_batches_(in_batches) {}

  void check(std::span<const ArmPositions> configurations,
             std::span<std::uint8_t> verdicts) override {
    if (configurations.empty()) return;
    if (in_batches_) {
      checker_.check_configs({configurations.front().data(), configurations.size() * kJoints},
                             scratch_, verdicts);
      for (std::uint8_t& verdict : verdicts) verdict ^= 1U;  // free to colliding
      return;
    }
    for (std::size_t i = 0; i < configurations.size(); ++i) {
      verdicts[i] = checker_.check_config(configurations[i], scratch_) ? 0 : 1;
    }
  }

 private:
  RobotChecker checker_;
  RobotChecker::Scratch scratch_;
  bool in_batches_;
};

class PairTreeChecker : public SingleChecker {
 public:
  explicit PairTreeChecker(const Workload& workload) : SingleChecker(workload.robot) {
    for (const Body& body : workload.bodies) {
      for (const Obstacle& obstacle : workload.obstacles) {
        if (!is_tested(body, obstacle)) continue;
        pairs_.push_back({body.part.tree, static_cast<std::size_t>(body.link), obstacle.part.tree,
                          obstacle.world_from_part});
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    return std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
      return spherule::collides(*pair.body, world_from_link[pair.link], *pair.obstacle,
                                pair.world_from_obstacle);
    });
  }

 private:
  struct Pair {
    std::shared_ptr<const SphereTree> body;
    std::size_t link;
    std::shared_ptr<const SphereTree> obstacle;
    Pose world_from_obstacle;
  };
  std::vector<Pair> pairs_;
};

}  // namespace

RobotChecker make_robot_checker(const Workload& workload, InstructionSet instructions,
                                UsedMeshes used) {
  RobotModel robot = workload.robot;
  RobotCheckerOptions options{.instructions = instructions};
  const auto add_mesh = [&](const Part& part) {
    options.meshes.push_back(std::make_shared<const CoveredMesh>(part.mesh, part.tree));
  };
  const auto link_of = [&](const Body& body) {
    return robot.links()[static_cast<std::size_t>(body.link)].name;
  };
  for (const Body& body : workload.bodies) {
    robot.attach(link_of(body), body.part.tree);
    if (used != UsedMeshes::kNone) add_mesh(body.part);
  }
  AllowedCollisions allowed(robot);
  allowed.allow_all();
  RobotScene scene(robot);
  scene.set_allowed_collisions(std::move(allowed));
  for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
    const Obstacle& obstacle = workload.obstacles[i];
    const std::string name = "obstacle " + std::to_string(i);
    scene.add(name, obstacle.part.tree, obstacle.world_from_part);
    if (used == UsedMeshes::kAll) add_mesh(obstacle.part);
    for (const Body& body : workload.bodies) {
      if (!is_tested(body, obstacle)) scene.allow_contact(link_of(body), name);
    }
  }
  return scene.snapshot(options);
}

std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode,
                                           InstructionSet instructions) {
  if (mode == TreeMode::kPairs) return std::make_unique<PairTreeChecker>(workload);
  const UsedMeshes used = mode == TreeMode::kConfirmed ? UsedMeshes::kAll
                          : mode == TreeMode::kMeshes  ? UsedMeshes::kOfRobot
                                                       : UsedMeshes::kNone;
  return std::make_unique<TreeChecker>(make_robot_checker(workload, instructions, used),
                                       mode == TreeMode::kBatch);
}

}  // namespace spherule
