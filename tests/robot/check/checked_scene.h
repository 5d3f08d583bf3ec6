// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Random robots with spheres among sphere trees.

#include "robot/check/robot_scene.h"
#include "tests/support/random.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {

// A tree that stands still.
struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree{};
};

struct ObstacleOptions {
  Pose world_from_root{};
  std::vector<std::shared_ptr<const CoveredMesh>> meshes{};
  InstructionSet instructions = best_instruction_set();
};

// Its links are not tested against each other.
RobotScene scene_without_self_tests(const RobotModel& robot, const Pose& world_from_root = {});

// Of a robot among trees, whose links are not tested against each other. The k-th obstacle is
// obstacle_name(k).
RobotChecker obstacle_checker(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                              const ObstacleOptions& options = {});
std::string obstacle_name(std::size_t index);

// Where a robot's root may stand: a pose that a RobotScene takes as it is.
Pose random_root(Random& random, double size);

// Up to 60 spheres within `size`.
std::shared_ptr<const SphereTree> random_tree(Random& random, double size);

// A quarter of them have joints that follow others.
RobotModel random_robot_with_trees(Random& random, double size);

// One to three obstacles.
std::vector<PlacedTree> random_obstacles(Random& random);

// One of the spheres that are not on the first link, in the world; none if there are none.
std::optional<Sphere> random_sphere_of(Random& random, const RobotModel& robot,
                                       std::span<const Pose> world_from_link);

// Whether a tree of a link touches an obstacle, by the exact queries of two trees.
bool answer(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
            std::span<const double> configuration, const Pose& world_from_root = {});

}  // namespace spherule::test
