// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/standing_trees.h"

#include "collide/collide.h"
#include "collide/robot/internal/moving_frames.h"
#include "collide/robot/kinematics.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace spherule::internal {

StandingTrees::StandingTrees(const BodyPairs& pairs, InstructionSet instructions)
    : pairs_(pairs), positions_(pairs.robot()) {
  const RobotModel& robot = pairs.robot();
  const MovingFrames frames(robot);
  std::vector<Pose> at_zero;
  forward_kinematics(robot, std::vector<double>(static_cast<std::size_t>(robot.variable_count())),
                     at_zero, pairs.world_from_root());
  const Pose root_from_world = pairs.world_from_root().inverse();
  std::vector<MechanismBody> bodies;
  std::vector<MechanismObstacle> obstacles;
  bool has_meshes = false;
  std::vector<int> body_of_piece(pairs.pieces().size(), -1);
  std::vector<int> place_of(pairs.obstacles().size(), -1);
  for (std::size_t i = pairs.tested(); i < pairs.pairs().size(); ++i) {
    const CheckedPair& pair = pairs.pairs()[i];
    const auto index = static_cast<std::size_t>(pair.piece);
    const CheckedPiece& piece = pairs.pieces()[index];
    const auto link = static_cast<std::size_t>(piece.link);
    int& place = place_of[static_cast<std::size_t>(pair.other)];
    if (place < 0) {
      const PlacedShape& placed = pairs.obstacles()[static_cast<std::size_t>(pair.other)];
      const auto& tree = std::get<std::shared_ptr<const SphereTree>>(placed.shape);
      place = static_cast<int>(obstacles_.size());
      obstacles_.push_back({tree, placed.world_from_shape, placed.mesh.get()});
      obstacles.push_back({root_from_world * placed.world_from_shape, tree});
    }
    has_meshes = has_meshes || pairs.is_confirmed(pair);
    const Body body{&piece, frames.frame_of_link[link], frames.frame_from_link[link]};
    if (body.frame < 0) {
      always_ =
          always_ || pair_touches(body, obstacles_[static_cast<std::size_t>(place)], at_zero[link]);
      continue;
    }
    if (body_of_piece[index] < 0) {
      body_of_piece[index] = static_cast<int>(bodies_.size());
      bodies_.push_back(body);
      bodies.push_back({body.frame, body.frame_from_link, piece.tree});
    }
    tested_.push_back({body_of_piece[index], place});
  }
  check_ = std::make_unique<const MechanismCheck>(frames.frames, bodies, obstacles, tested_,
                                                  pairs.pose_error(), instructions, has_meshes);
}

bool StandingTrees::touch(std::span<const double> configuration, Memory& memory) const {
  const std::span<const double> positions = positions_.of(configuration, memory.room_);
  if (!MechanismCheck::is_in_range(positions)) return touch_exactly(configuration, memory);
  if (always_) return true;
  bool is_placed = false;
  memory.unconfirmed_.clear();
  const auto confirm = [&](const MechanismContact& contact) {
    return touches(configuration, contact, is_placed, memory);
  };
  return check_->collides(positions, memory.check_, confirm) || contains_component(memory);
}

void StandingTrees::touch(std::span<const double> configurations, Memory& memory,
                          std::span<std::uint8_t> verdicts) const {
  constexpr std::size_t kBlock = MechanismCheck::kBlock;
  const auto variables = static_cast<std::size_t>(pairs_.robot().variable_count());
  const auto configuration = [&](std::size_t i) {
    return configurations.subspan(i * variables, variables);
  };
  for (std::size_t first = 0; first < verdicts.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, verdicts.size()) - 1;
    std::array<const double*, kBlock> block;  // filled up with the last one
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::size_t index = std::min(first + i, last);
      block[i] = positions_.of(configuration(index), memory.room_, i).data();
    }
    int placed = -1;
    std::uint32_t unconfirmed = 0;
    const MechanismCheck::BlockAnswer answer =
        check_->collides(block, memory.check_, [&](int index, const MechanismContact& contact) {
          bool is_placed = std::exchange(placed, index) == index;
          memory.unconfirmed_.clear();
          const std::size_t asked = std::min(first + static_cast<std::size_t>(index), last);
          const bool touch = touches(configuration(asked), contact, is_placed, memory);
          if (!memory.unconfirmed_.empty()) unconfirmed |= 1U << index;
          return touch;
        });
    for (std::size_t i = first; i <= last; ++i) {
      const auto says = [&](std::uint32_t bits) { return (bits >> (i - first) & 1U) != 0; };
      bool hit = always_ || says(answer.collides);
      if (says(answer.out_of_range)) {
        hit = touch_exactly(configuration(i), memory);
      } else if (!hit && says(unconfirmed)) {
        hit = touch(configuration(i), memory);
      }
      verdicts[i] = hit ? 1 : 0;
    }
  }
}

StandingTrees::AlongFinding StandingTrees::look_along(std::span<const double> from,
                                                      std::span<const double> to,
                                                      bool asks_for_contact, Memory& memory) const {
  if (always_) return AlongFinding::kUndecided;
  const std::optional<bool> is_free = check_->is_free_along(
      positions_.of(from, memory.room_, 0), positions_.of(to, memory.room_, 1), memory.check_);
  if (is_free.value_or(false)) return AlongFinding::kFree;
  if (!is_free || !asks_for_contact) return AlongFinding::kUndecided;
  memory.middle_.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) memory.middle_[i] = 0.5 * from[i] + 0.5 * to[i];
  return touch(memory.middle_, memory) ? AlongFinding::kTouchesInTheMiddle
                                       : AlongFinding::kUndecided;
}

// For the contacts of a configuration that are asked about.
void StandingTrees::place(std::span<const double> configuration, Memory& memory) const {
  forward_kinematics(pairs_.robot(), configuration, memory.world_from_link_,
                     pairs_.world_from_root());
}

// Whether the robot touches an obstacle at the contact, or where it last did: a robot that touches
// often did so a moment ago, by the same triangles. `is_placed` says whether the memory holds the
// configuration's poses.
bool StandingTrees::touches(std::span<const double> configuration, const MechanismContact& contact,
                            bool& is_placed, Memory& memory) const {
  if (!std::exchange(is_placed, true)) {
    place(configuration, memory);
    if (memory.last_ && still_touches(*memory.last_, memory)) return true;
  }
  const Finding finding = find(contact, memory);
  if (finding == Finding::kSpheres) {
    const auto is_same = [&](const MechanismPair& pair) {
      return pair.body == contact.pair.body && pair.obstacle == contact.pair.obstacle;
    };
    if (std::none_of(memory.unconfirmed_.begin(), memory.unconfirmed_.end(), is_same)) {
      memory.unconfirmed_.push_back(contact.pair);
    }
  }
  return finding == Finding::kTouch;
}

// The canonical test, and the one of the triangles.
StandingTrees::Finding StandingTrees::find(const MechanismContact& contact, Memory& memory) const {
  const Body& body = body_of(contact.pair);
  const Obstacle& obstacle = obstacle_of(contact.pair);
  const Pose& world_from_body = pose_of(body, memory);
  if (!spheres_touch(*body.piece->tree, contact.body_sphere, world_from_body, *obstacle.tree,
                     contact.obstacle_sphere, obstacle.world_from_tree)) {
    return Finding::kApart;
  }
  if (body.piece->mesh == nullptr || obstacle.mesh == nullptr) return Finding::kTouch;
  const std::optional<TrianglePair> triangles =
      touching_triangles(*body.piece->mesh, contact.body_sphere, world_from_body, *obstacle.mesh,
                         contact.obstacle_sphere, obstacle.world_from_tree);
  if (!triangles) return Finding::kSpheres;
  memory.last_ = {contact, *triangles};
  if (check_->is_following(memory.check_)) {
    remember(*memory.last_, depth_of(*memory.last_, memory), memory);
  }
  return Finding::kTouch;
}

// A robot that touches often did so a moment ago, by the same triangles or by others near to them.
// What is not proved by the former alone is left to the test of the spheres.
bool StandingTrees::still_touches(const Touch& touch, Memory& memory) const {
  if (check_->is_following(memory.check_)) {
    const double depth = depth_of(touch, memory);
    if (depth > 0.0) {
      remember(touch, depth, memory);
      return true;
    }
  }
  return find(touch.contact, memory) == Finding::kTouch;
}

double StandingTrees::depth_of(const Touch& touch, const Memory& memory) const {
  const Body& body = body_of(touch.contact.pair);
  const Obstacle& obstacle = obstacle_of(touch.contact.pair);
  return contact_depth(*body.piece->mesh, pose_of(body, memory), *obstacle.mesh,
                       obstacle.world_from_tree, touch.triangles);
}

// The poses of forward_kinematics() are within pose_error() of those of the exact mechanism, now
// and wherever the memory is asked for; as much again covers the ball's.
void StandingTrees::remember(const Touch& touch, double depth, Memory& memory) const {
  if (depth <= 3.0 * pairs_.pose_error()) return;
  const Body& body = body_of(touch.contact.pair);
  const auto& [p, q, r] = body.piece->mesh->mesh().triangle(touch.triangles.a);
  const Eigen::Vector3d center = (p + q + r) / 3.0;
  const double radius =
      std::max({distance_upper(center, p), distance_upper(center, q), distance_upper(center, r)});
  check_->remember_contact(body.frame, {body.frame_from_link * center, radius},
                           depth - 3.0 * pairs_.pose_error(), memory.check_);
}

// Where no triangles touch but spheres do, under the poses that the memory holds.
bool StandingTrees::contains_component(const Memory& memory) const {
  return std::any_of(
      memory.unconfirmed_.begin(), memory.unconfirmed_.end(), [&](const MechanismPair& pair) {
        const Body& body = body_of(pair);
        const Obstacle& obstacle = obstacle_of(pair);
        return spherule::contains_component(*body.piece->mesh, pose_of(body, memory),
                                            *obstacle.mesh, obstacle.world_from_tree);
      });
}

bool StandingTrees::pair_touches(const Body& body, const Obstacle& obstacle,
                                 const Pose& world_from_link) const {
  if (body.piece->mesh == nullptr || obstacle.mesh == nullptr) {
    return spherule::collides(*body.piece->tree, world_from_link, *obstacle.tree,
                              obstacle.world_from_tree);
  }
  return spherule::collides(*body.piece->mesh, world_from_link, *obstacle.mesh,
                            obstacle.world_from_tree);
}

bool StandingTrees::touch_exactly(std::span<const double> configuration, Memory& memory) const {
  place(configuration, memory);
  return always_ || std::any_of(tested_.begin(), tested_.end(), [&](const MechanismPair& pair) {
           const Body& body = body_of(pair);
           return pair_touches(body, obstacle_of(pair), pose_of(body, memory));
         });
}

}  // namespace spherule::internal
