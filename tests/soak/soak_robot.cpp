// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_robot.h"

#include "collide/collide.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace spherule {
namespace {

constexpr double kSize = 0.4;

std::vector<SoakObstacle> make_obstacles(SceneRandom& random) {
  std::vector<SoakObstacle> obstacles;
  for (int i = random.whole(1, 3); i > 0; --i) {
    const int count = random.chance(0.95) ? random.whole(1, 12) : random.whole(100, 300);
    obstacles.push_back({std::make_shared<const SphereTree>(random_tree(random, count, kSize)),
                         Pose(random.rotation(), random.in_cube(2.0 * kSize))});
  }
  return obstacles;
}

// Its first joint leads it past `aim`.
RobotModel make_robot(SceneRandom& random, const Eigen::Vector3d& aim,
                      const Eigen::Vector3d& direction) {
  RobotModel robot("link_0");
  const int joints = random.whole(1, 5);
  for (int i = 0; i < joints; ++i) {
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = JointType::kPrismatic;
    joint.axis = direction;
    joint.parent_from_joint = Pose::from_translation(aim);
    if (i > 0) {
      joint.type = random.chance(0.2) ? JointType::kPrismatic : JointType::kRevolute;
      joint.axis = random.direction();
      joint.parent_from_joint = Pose(random.rotation(), random.in_cube(kSize));
    }
    joint.lower = -100.0;
    joint.upper = 100.0;
    const int parent = i == 0 ? 0 : random.whole(1, i);
    const std::string link = "link_" + std::to_string(i + 1);
    robot.add_link(link, "link_" + std::to_string(parent), joint);
    if (i + 1 == joints || random.chance(0.5)) {
      robot.attach(link, std::make_shared<const SphereTree>(
                             random_tree(random, random.whole(1, 12), 0.5 * kSize)));
    }
  }
  return robot;
}

}  // namespace

SoakRobot::SoakRobot(SceneRandom& random)
    : obstacles_(make_obstacles(random)),
      direction_(random.direction()),
      robot_(make_robot(random,
                        obstacles_[0].world_from_tree * obstacles_[0].tree->spheres()[0].center,
                        direction_)) {
  for (const SoakObstacle& obstacle : obstacles_) {
    add_placed(obstacle.tree->spheres(), obstacle.world_from_tree, static_);
  }
}

RobotScene SoakRobot::scene() const {
  RobotScene scene(robot_);
  AllowedCollisions allowed(robot_);
  allowed.allow_all();
  scene.set_allowed_collisions(std::move(allowed));
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    scene.add("obstacle " + std::to_string(i), obstacles_[i].tree, obstacles_[i].world_from_tree);
  }
  return scene;
}

std::vector<double> SoakRobot::anywhere(SceneRandom& random) const {
  std::vector<double> configuration{random.between(-3.0, 3.0)};
  for (int i = 1; i < robot_.variable_count(); ++i) {
    configuration.push_back(random.between(-std::numbers::pi, std::numbers::pi));
  }
  return configuration;
}

template <class Use>
bool SoakRobot::any_pair(std::span<const double> configuration, Use use) {
  forward_kinematics(robot_, configuration, world_from_link_);
  for (std::size_t link = 0; link < robot_.links().size(); ++link) {
    for (const auto& tree : robot_.links()[link].trees) {
      for (const SoakObstacle& obstacle : obstacles_) {
        if (use(*tree, world_from_link_[link], obstacle)) return true;
      }
    }
  }
  return false;
}

bool SoakRobot::bring_to_gap(std::vector<double>& configuration, double gap) {
  configuration[0] = 0.0;
  forward_kinematics(robot_, configuration, world_from_link_);
  movers_.clear();
  for (std::size_t link = 0; link < robot_.links().size(); ++link) {
    for (const auto& tree : robot_.links()[link].trees) {
      add_placed(tree->spheres(), world_from_link_[link], movers_);
    }
  }
  const auto way = way_to_gap(static_, movers_, direction_, gap);
  if (!way || std::abs(*way) > RobotChecker::kLargestPosition) return false;
  configuration[0] = *way;
  return true;
}

bool SoakRobot::touches(std::span<const double> configuration) {
  return any_pair(
      configuration, [&](const SphereTree& tree, const Pose& pose, const SoakObstacle& obstacle) {
        return oracle_.within({tree.spheres(), pose},
                              {obstacle.tree->spheres(), obstacle.world_from_tree}, 0.0);
      });
}

GapBounds SoakRobot::gap(std::span<const double> configuration) {
  constexpr long double kFar = std::numeric_limits<double>::infinity();
  GapBounds least{kFar, kFar};
  any_pair(configuration,
           [&](const SphereTree& tree, const Pose& pose, const SoakObstacle& obstacle) {
             const GapBounds gap = oracle_.gap(
                 {tree.spheres(), pose}, {obstacle.tree->spheres(), obstacle.world_from_tree});
             least.lower = std::min(least.lower, gap.lower);
             least.upper = std::min(least.upper, gap.upper);
             return false;
           });
  return least;
}

double SoakRobot::slack(std::span<const double> configuration) {
  double largest = 0.0;
  any_pair(configuration,
           [&](const SphereTree& tree, const Pose& pose, const SoakObstacle& obstacle) {
             largest = std::max(
                 largest, collision_slack(tree, pose, *obstacle.tree, obstacle.world_from_tree));
             return false;
           });
  return largest;
}

}  // namespace spherule
