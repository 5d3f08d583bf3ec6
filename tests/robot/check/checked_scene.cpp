// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/check/checked_scene.h"

#include "collide/collide.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/robots.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <utility>

namespace spherule::test {

RobotScene scene_without_self_tests(const RobotModel& robot, const Pose& world_from_root) {
  RobotScene scene(robot, world_from_root);
  AllowedCollisions allowed(robot);
  allowed.allow_all();
  scene.set_allowed_collisions(std::move(allowed));
  return scene;
}

RobotChecker obstacle_checker(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                              const ObstacleOptions& options) {
  RobotScene scene = scene_without_self_tests(robot, options.world_from_root);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    scene.add(obstacle_name(i), obstacles[i].tree, obstacles[i].world_from_tree);
  }
  return scene.snapshot({.instructions = options.instructions, .meshes = options.meshes});
}

std::string obstacle_name(std::size_t index) {
  return "obstacle " + std::to_string(index);
}

Pose random_root(Random& random, double size) {
  const Pose pose = random.pose(size);
  return Pose(unit_rotation(pose.rotation()), pose.translation());
}

std::shared_ptr<const SphereTree> random_tree(Random& random, double size) {
  const int count = random.whole(1, 60);
  std::vector<Sphere> spheres = random_spheres(random, count, size, 0.1 * size);
  return std::make_shared<const SphereTree>(
      build_tree(spheres, {.branching = random.whole(2, SphereTree::kMaxBranching)}));
}

RobotModel random_robot_with_trees(Random& random, double size) {
  // One after the other, as the order in which arguments are evaluated is the compiler's.
  const bool branching = random.whole(0, 1) == 1;
  RobotModel robot = random_robot(random, random.whole(1, 8), branching);
  if (random.whole(0, 3) == 0) add_random_mimics(random, robot, 3.0);
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (int i = random.whole(0, 2); i > 0; --i) {
      robot.attach(robot.links()[link].name, random_tree(random, size));
    }
  }
  return robot;
}

std::vector<PlacedTree> random_obstacles(Random& random) {
  std::vector<PlacedTree> obstacles;
  for (int k = random.whole(1, 3); k > 0; --k) {
    obstacles.push_back({random_tree(random, 1.0), random.pose(2.0)});
  }
  return obstacles;
}

std::optional<Sphere> random_sphere_of(Random& random, const RobotModel& robot,
                                       std::span<const Pose> world_from_link) {
  std::vector<Sphere> spheres;
  for (std::size_t link = 1; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      const Sphere& one = tree->spheres()[random.bits() % tree->spheres().size()];
      spheres.push_back({world_from_link[link] * one.center, one.radius});
    }
  }
  if (spheres.empty()) return std::nullopt;
  return spheres[random.bits() % spheres.size()];
}

bool answer(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
            std::span<const double> configuration, const Pose& world_from_root) {
  std::vector<Pose> world_from_link;
  forward_kinematics(robot, configuration, world_from_link, world_from_root);
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      for (const PlacedTree& other : obstacles) {
        if (collides(*tree, world_from_link[link], *other.tree, other.world_from_tree)) return true;
      }
    }
  }
  return false;
}

}  // namespace spherule::test
