// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/robot_mesh_checker.h"

#include "collide/robot/internal/moving_frames.h"
#include "collide/robot/internal/tested_pairs.h"
#include "collide/robot/kinematics.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace spherule {
namespace {

void check_input(const RobotModel& robot, std::span<const LinkMesh> meshes,
                 std::span<const PlacedTree> obstacles, std::span<const UntestedPair> untested) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string name = "mesh " + std::to_string(i);
    if (!meshes[i].mesh) throw Error(name, "it is missing");
    if (meshes[i].link < 0 || static_cast<std::size_t>(meshes[i].link) >= robot.links().size()) {
      throw Error(name, "it is on no link");
    }
  }
  internal::check_obstacles(obstacles);
  internal::check_untested(untested, robot, obstacles.size());
}

}  // namespace

RobotMeshChecker::RobotMeshChecker(RobotModel robot, std::vector<LinkMesh> meshes,
                                   std::vector<PlacedTree> obstacles,
                                   const RobotMeshCheckerOptions& options)
    : robot_(std::move(robot)),
      meshes_(std::move(meshes)),
      obstacles_(std::move(obstacles)),
      world_from_root_(options.world_from_root),
      positions_(robot_) {
  check_input(robot_, meshes_, obstacles_, options.untested);
  const internal::MovingFrames frames(robot_);
  std::vector<Pose> standing;
  forward_kinematics(robot_, std::vector<double>(static_cast<std::size_t>(robot_.variable_count())),
                     standing, world_from_root_);
  std::vector<MechanismMesh> bodies;
  std::vector<MechanismPair> pairs;
  double reach = 0.0;
  double scene = 0.0;
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    const auto link = static_cast<std::size_t>(meshes_[i].link);
    const bool moves = frames.frame_of_link[link] >= 0;
    reach = std::max(reach, meshes_[i].mesh->tree().reach());
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      if (internal::is_untested(options.untested, link, k)) continue;
      pairs_.push_back({i, k});
      if (moves) {
        pairs.push_back({static_cast<int>(bodies.size()), static_cast<int>(k)});
      } else {
        always_ = always_ || meets(pairs_.back(), standing);
      }
    }
    if (!moves) continue;
    moving_.push_back(i);
    bodies.push_back({frames.frame_of_link[link], frames.frame_from_link[link], meshes_[i].mesh});
  }
  std::vector<MechanismObstacle> placed;
  const Pose root_from_world = world_from_root_.inverse();
  for (const PlacedTree& obstacle : obstacles_) {
    placed.push_back({root_from_world * obstacle.world_from_tree, obstacle.tree});
    scene = std::max(scene, obstacle.tree->reach() + obstacle.world_from_tree.translation().norm());
  }
  check_ = std::make_shared<const MeshMechanismCheck>(
      frames.frames, bodies, placed, pairs,
      internal::moving_pose_error(robot_, reach, scene, world_from_root_.translation().norm()),
      options.instructions);
}

bool RobotMeshChecker::meets(const Pair& pair, const std::vector<Pose>& world_from_link) const {
  const LinkMesh& mesh = meshes_[pair.mesh];
  const PlacedTree& obstacle = obstacles_[pair.obstacle];
  return spherule::collides(*obstacle.tree, obstacle.world_from_tree, *mesh.mesh,
                            world_from_link[static_cast<std::size_t>(mesh.link)]);
}

bool RobotMeshChecker::collides(std::span<const double> configuration, Scratch& scratch) const {
  if (scratch.check_ != check_) throw Error("scratch", "it was made for another checker");
  const bool has_size = configuration.size() == static_cast<std::size_t>(robot_.variable_count());
  const std::span<const double> positions =
      has_size ? positions_.of(configuration, scratch.room_) : configuration;
  std::vector<Pose>& placed = scratch.world_from_link_;
  if (!has_size || !MechanismCheck::is_in_range(positions)) {
    forward_kinematics(robot_, configuration, placed, world_from_root_);
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const Pair& pair) { return meets(pair, placed); });
  }
  if (always_) return true;
  bool is_placed = false;
  return check_->collides(positions, scratch.memory_, [&](const MeshContactInDoubt& contact) {
    if (!is_placed) forward_kinematics(robot_, configuration, placed, world_from_root_);
    is_placed = true;
    const LinkMesh& mesh = meshes_[moving_[static_cast<std::size_t>(contact.pair.body)]];
    const PlacedTree& obstacle = obstacles_[static_cast<std::size_t>(contact.pair.obstacle)];
    return meets_triangle(*obstacle.tree, contact.sphere, obstacle.world_from_tree, *mesh.mesh,
                          contact.triangle, placed[static_cast<std::size_t>(mesh.link)]);
  });
}

}  // namespace spherule
