// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/robot_tree_checker.h"

#include "collide/collide.h"
#include "collide/robot/internal/moving_frames.h"
#include "collide/robot/internal/tested_pairs.h"
#include "collide/robot/kinematics.h"
#include "collide/within.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <string>
#include <utility>

namespace spherule {
namespace {

// Bounds for the whole robot and scene at once.
double pose_error(const RobotModel& robot, std::span<const PlacedTree> obstacles,
                  const Pose& world_from_root) {
  double reach = 0.0;
  double scene = 0.0;
  for (const Link& link : robot.links()) {
    for (const auto& tree : link.trees) reach = std::max(reach, tree->reach());
  }
  for (const PlacedTree& obstacle : obstacles) {
    scene = std::max(scene, obstacle.tree->reach() + obstacle.world_from_tree.translation().norm());
  }
  return internal::moving_pose_error(robot, reach, scene, world_from_root.translation().norm());
}

void check_input(const RobotModel& robot, std::span<const PlacedTree> obstacles,
                 const RobotTreeCheckerOptions& options) {
  internal::check_obstacles(obstacles);
  for (const auto& mesh : options.meshes) {
    if (!mesh) throw Error("robot checker", "a mesh is missing");
  }
  internal::check_untested(options.untested, robot, obstacles.size());
}

}  // namespace

RobotTreeChecker::RobotTreeChecker(RobotModel robot, std::vector<PlacedTree> obstacles,
                                   const RobotTreeCheckerOptions& options)
    : robot_(std::move(robot)),
      obstacles_(std::move(obstacles)),
      world_from_root_(options.world_from_root),
      meshes_(options.meshes),
      positions_(robot_) {
  check_input(robot_, obstacles_, options);
  const internal::MovingFrames frames(robot_);
  std::vector<Pose> standing;
  forward_kinematics(robot_, std::vector<double>(static_cast<std::size_t>(robot_.variable_count())),
                     standing, world_from_root_);
  for (const PlacedTree& obstacle : obstacles_) {
    obstacle_meshes_.push_back(mesh_of(*obstacle.tree));
  }
  std::vector<MechanismBody> bodies;
  for (std::size_t link = robot_.links().size(); link-- > 0;) {
    const auto& trees = robot_.links()[link].trees;
    for (std::size_t index = 0; index < trees.size(); ++index) {
      const auto& tree = trees[index];
      const Body body{.tree = tree,
                      .link = link,
                      .tree_index = index,
                      .mesh = mesh_of(*tree),
                      .frame = frames.frame_of_link[link],
                      .frame_from_link = frames.frame_from_link[link]};
      const bool moves = frames.frame_of_link[link] >= 0;
      for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        if (internal::is_untested(options.untested, link, i)) continue;
        if (moves) {
          pairs_.push_back({static_cast<int>(bodies_.size()), static_cast<int>(i)});
        } else {
          standing_.push_back({body, standing[link], i});
          always_ = always_ || body_collides(body, standing[link], i);
        }
      }
      if (!moves) continue;
      bodies_.push_back(body);
      bodies.push_back({frames.frame_of_link[link], frames.frame_from_link[link], tree});
    }
  }
  std::vector<MechanismObstacle> placed;
  const Pose root_from_world = world_from_root_.inverse();
  for (const PlacedTree& obstacle : obstacles_) {
    placed.push_back({root_from_world * obstacle.world_from_tree, obstacle.tree});
  }
  pose_error_ = pose_error(robot_, obstacles_, world_from_root_);
  check_ = std::make_shared<const MechanismCheck>(
      frames.frames, bodies, placed, pairs_, pose_error_, options.instructions, !meshes_.empty());
}

const CoveredMesh* RobotTreeChecker::mesh_of(const SphereTree& tree) const {
  const auto found = std::find_if(meshes_.begin(), meshes_.end(),
                                  [&](const auto& mesh) { return &mesh->cover() == &tree; });
  return found == meshes_.end() ? nullptr : found->get();
}

// What the fast check is asked for, if it can be.
std::optional<std::span<const double>> RobotTreeChecker::usual_positions(
    std::span<const double> configuration, Scratch& scratch, std::size_t place) const {
  if (configuration.size() != static_cast<std::size_t>(robot_.variable_count())) return {};
  const std::span<const double> positions = positions_.of(configuration, scratch.room_, place);
  if (!MechanismCheck::is_in_range(positions)) return {};
  return positions;
}

bool RobotTreeChecker::collides(std::span<const double> configuration, Scratch& scratch) const {
  require_own(scratch);
  const auto positions = usual_positions(configuration, scratch);
  if (!positions) return collides_exactly(configuration, scratch);
  if (always_) return true;
  bool is_placed = false;
  scratch.unconfirmed_.clear();
  const auto confirm = [&](const MechanismContact& contact) {
    return touches(configuration, contact, is_placed, scratch);
  };
  return check_->collides(*positions, scratch.memory_, confirm) || contains_component(scratch);
}

bool RobotTreeChecker::within(std::span<const double> configuration, double clearance,
                              Scratch& scratch) const {
  require_own(scratch);
  require_clearance(clearance);
  const auto is_near = [&](const Body& body, const Pose& world_from_link, std::size_t obstacle) {
    return spherule::within(*body.tree, world_from_link, *obstacles_[obstacle].tree,
                            obstacles_[obstacle].world_from_tree, clearance);
  };
  const bool stands_near =
      std::any_of(standing_.begin(), standing_.end(), [&](const Standing& pair) {
        return is_near(pair.body, pair.world_from_link, pair.obstacle);
      });
  std::vector<Pose>& world_from_link = scratch.world_from_link_;
  const auto positions = usual_positions(configuration, scratch);
  if (!positions) {
    forward_kinematics(robot_, configuration, world_from_link, world_from_root_);
    return stands_near || std::any_of(pairs_.begin(), pairs_.end(), [&](const MechanismPair& pair) {
             const Body& body = bodies_[static_cast<std::size_t>(pair.body)];
             return is_near(body, world_from_link[body.link],
                            static_cast<std::size_t>(pair.obstacle));
           });
  }
  bool is_placed = false;
  const auto confirm = [&](const MechanismContact& contact) {
    if (!std::exchange(is_placed, true)) {
      forward_kinematics(robot_, configuration, world_from_link, world_from_root_);
    }
    const Body& body = bodies_[static_cast<std::size_t>(contact.pair.body)];
    const PlacedTree& obstacle = obstacles_[static_cast<std::size_t>(contact.pair.obstacle)];
    return spheres_within(*body.tree, contact.body_sphere, world_from_link[body.link],
                          *obstacle.tree, contact.obstacle_sphere, obstacle.world_from_tree,
                          clearance);
  };
  return check_->within(*positions, clearance, scratch.memory_, confirm) || stands_near;
}

// Whether the robot touches an obstacle at the contact, or where it last did: a robot that touches
// often did so a moment ago, by the same triangles. `is_placed` says whether the scratch holds the
// configuration's poses.
bool RobotTreeChecker::touches(std::span<const double> configuration,
                               const MechanismContact& contact, bool& is_placed,
                               Scratch& scratch) const {
  if (!is_placed) {
    forward_kinematics(robot_, configuration, scratch.world_from_link_, world_from_root_);
    is_placed = true;
    if (scratch.last_ && touches_still(*scratch.last_, scratch)) return true;
  }
  const Finding finding = find(contact, scratch);
  if (finding == Finding::kSpheres) {
    const auto is_same = [&](const MechanismPair& pair) {
      return pair.body == contact.pair.body && pair.obstacle == contact.pair.obstacle;
    };
    if (std::none_of(scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), is_same)) {
      scratch.unconfirmed_.push_back(contact.pair);
    }
  }
  return finding == Finding::kTouch;
}

// The canonical test, and the one of the triangles.
RobotTreeChecker::Finding RobotTreeChecker::find(const MechanismContact& contact,
                                                 Scratch& scratch) const {
  const Body& body = bodies_[static_cast<std::size_t>(contact.pair.body)];
  const auto index = static_cast<std::size_t>(contact.pair.obstacle);
  const PlacedTree& obstacle = obstacles_[index];
  const Pose& world_from_body = scratch.world_from_link_[body.link];
  if (!spheres_touch(*body.tree, contact.body_sphere, world_from_body, *obstacle.tree,
                     contact.obstacle_sphere, obstacle.world_from_tree)) {
    return Finding::kApart;
  }
  const CoveredMesh* const mesh = obstacle_meshes_[index];
  if (body.mesh == nullptr || mesh == nullptr) return Finding::kTouch;
  const std::optional<TrianglePair> triangles =
      touching_triangles(*body.mesh, contact.body_sphere, world_from_body, *mesh,
                         contact.obstacle_sphere, obstacle.world_from_tree);
  if (!triangles) return Finding::kSpheres;
  scratch.last_ = {contact, *triangles};
  if (check_->is_following(scratch.memory_)) {
    remember(*scratch.last_, depth_of(*scratch.last_, scratch), scratch);
  }
  return Finding::kTouch;
}

// A robot that touches often did so a moment ago, by the same triangles or by others near to them.
// What is not proved by the former alone is left to the test of the spheres.
bool RobotTreeChecker::touches_still(const Touch& touch, Scratch& scratch) const {
  if (check_->is_following(scratch.memory_)) {
    const double depth = depth_of(touch, scratch);
    if (depth > 0.0) {
      remember(touch, depth, scratch);
      return true;
    }
  }
  return find(touch.contact, scratch) == Finding::kTouch;
}

double RobotTreeChecker::depth_of(const Touch& touch, const Scratch& scratch) const {
  const Body& body = bodies_[static_cast<std::size_t>(touch.contact.pair.body)];
  const auto obstacle = static_cast<std::size_t>(touch.contact.pair.obstacle);
  return contact_depth(*body.mesh, scratch.world_from_link_[body.link], *obstacle_meshes_[obstacle],
                       obstacles_[obstacle].world_from_tree, touch.triangles);
}

// The poses of forward_kinematics() are within pose_error_ of those of the exact mechanism, now and
// wherever the memory is asked for; as much again covers the ball's.
void RobotTreeChecker::remember(const Touch& touch, double depth, Scratch& scratch) const {
  if (depth <= 3.0 * pose_error_) return;
  const Body& body = bodies_[static_cast<std::size_t>(touch.contact.pair.body)];
  const auto& [p, q, r] = body.mesh->mesh().triangle(touch.triangles.a);
  const Eigen::Vector3d center = (p + q + r) / 3.0;
  const double radius =
      std::max({distance_upper(center, p), distance_upper(center, q), distance_upper(center, r)});
  check_->remember_contact(body.frame, {body.frame_from_link * center, radius},
                           depth - 3.0 * pose_error_, scratch.memory_);
}

// Where no triangles touch but spheres do, under the poses that the scratch holds.
bool RobotTreeChecker::contains_component(Scratch& scratch) const {
  return std::any_of(
      scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), [&](const MechanismPair& pair) {
        const Body& body = bodies_[static_cast<std::size_t>(pair.body)];
        const auto obstacle = static_cast<std::size_t>(pair.obstacle);
        return spherule::contains_component(*body.mesh, scratch.world_from_link_[body.link],
                                            *obstacle_meshes_[obstacle],
                                            obstacles_[obstacle].world_from_tree);
      });
}

bool RobotTreeChecker::body_collides(const Body& body, const Pose& world_from_link,
                                     std::size_t obstacle) const {
  const PlacedTree& other = obstacles_[obstacle];
  const CoveredMesh* const mesh = obstacle_meshes_[obstacle];
  if (body.mesh == nullptr || mesh == nullptr) {
    return spherule::collides(*body.tree, world_from_link, *other.tree, other.world_from_tree);
  }
  return spherule::collides(*body.mesh, world_from_link, *mesh, other.world_from_tree);
}

EdgeResult RobotTreeChecker::check_edge(std::span<const double> from, std::span<const double> to,
                                        Scratch& scratch, const EdgeRequest& request) const {
  require_own(scratch);
  const auto positions_at = [&](std::span<const double> end, std::size_t place) {
    const auto positions = usual_positions(end, scratch, place);
    if (positions) return *positions;
    throw Error("edge", "an end has " + std::to_string(end.size()) + " positions, for a robot of " +
                            std::to_string(robot_.variable_count()) + " variables, or one beyond " +
                            std::to_string(MechanismCheck::kLargestVariable));
  };
  const std::span<const double> first = positions_at(from, 0);
  const std::span<const double> last = positions_at(to, 1);
  require_resolution(request.resolution);
  if (always_) return {.verdict = Verdict::kCollision, .contact_at = 0.0};
  std::uint64_t placed = 0;  // configurations are numbered from one
  scratch.unconfirmed_.clear();
  return check_->check_edge(
      first, last, scratch.memory_, request,
      [&](std::uint64_t number, std::span<const double> at, const MechanismContact& contact) {
        bool is_placed = std::exchange(placed, number) == number;
        return touches(positions_.configuration_at(at, scratch.room_), contact, is_placed, scratch);
      });
}

bool RobotTreeChecker::collides_exactly(std::span<const double> configuration,
                                        Scratch& scratch) const {
  std::vector<Pose>& world_from_link = scratch.world_from_link_;
  forward_kinematics(robot_, configuration, world_from_link, world_from_root_);
  return always_ || std::any_of(pairs_.begin(), pairs_.end(), [&](const MechanismPair& pair) {
           const Body& body = bodies_[static_cast<std::size_t>(pair.body)];
           return body_collides(body, world_from_link[body.link],
                                static_cast<std::size_t>(pair.obstacle));
         });
}

}  // namespace spherule
