// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Random robots with spheres among sphere trees, and what a RobotChecker has to say of them.

#include "robot/check/robot_scene.h"
#include "tests/support/random.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {

// A tree that stands still.
struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

// A link and an obstacle that need not be tested, by their indices.
struct UntestedPair {
  int link = 0;
  std::size_t obstacle = 0;
};

struct ObstacleOptions {
  Pose world_from_root{};
  std::vector<std::shared_ptr<const CoveredMesh>> meshes{};
  std::vector<UntestedPair> untested{};
  InstructionSet instructions = best_instruction_set();
};

// A RobotChecker of a robot among trees, whose links are not tested against each other. The k-th
// obstacle is obstacle_name(k).
class ObstacleChecker : public RobotChecker {
 public:
  ObstacleChecker(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                  const ObstacleOptions& options = {});

  bool collides(std::span<const double> configuration, Scratch& scratch) const {
    return !check_config(configuration, scratch);
  }
  // With one scratch or several; 1 if a configuration collides.
  template <class Scratches>
  void collides(std::span<const double> configurations, Scratches&& scratches,
                std::span<std::uint8_t> verdicts) const {
    check_configs(configurations, scratches, verdicts);
    for (std::uint8_t& verdict : verdicts) verdict ^= 1U;
  }
};
std::string obstacle_name(std::size_t index);

// Where a robot's root may stand: a pose that a RobotScene takes as it is.
Pose random_root(Random& random, double size);

// Up to 60 spheres within `size`.
std::shared_ptr<const SphereTree> random_tree(Random& random, double size);

RobotModel random_robot_with_trees(Random& random, double size);

// One to three obstacles.
std::vector<PlacedTree> random_obstacles(Random& random);

// One of the spheres that are not on the first link, in the world; none if there are none.
std::optional<Sphere> random_sphere_of(Random& random, const RobotModel& robot,
                                       std::span<const Pose> world_from_link);

// By the exact queries.
bool answer(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
            std::span<const double> configuration, const ObstacleOptions& options);

}  // namespace spherule::test
