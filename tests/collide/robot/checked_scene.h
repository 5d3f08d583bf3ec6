// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Random robots with spheres among random obstacles, and what a RobotTreeChecker has to say of
// them.

#include "collide/robot/robot_tree_checker.h"
#include "tests/collide/scene_random.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule::test {

// Up to 60 spheres within `size`.
std::shared_ptr<const SphereTree> random_tree(SceneRandom& random, double size);

RobotModel random_robot_with_trees(SceneRandom& random, double size);

// One to three obstacles.
std::vector<PlacedTree> random_obstacles(SceneRandom& random);

// One of the spheres that are not on the first link, in the world; none if there are none.
std::optional<Sphere> random_sphere_of(SceneRandom& random, const RobotModel& robot,
                                       std::span<const Pose> world_from_link);

// By the exact queries.
bool answer(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
            std::span<const double> configuration, const RobotTreeCheckerOptions& options);

}  // namespace spherule::test
