// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/internal/static_trees.h"

#include "collide/collide.h"
#include "robot/model/internal/moving_frames.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace spherule::internal {

StaticTrees::StaticTrees(const BodyPairs& pairs, InstructionSet instructions)
    : pairs_(pairs), positions_(pairs.robot()) {
  const RobotModel& robot = pairs.robot();
  const MovingFrames frames(robot);
  BodyPairs::Memory at_zero;
  pairs.place(std::vector<double>(static_cast<std::size_t>(robot.variable_count())), at_zero);
  const Pose root_from_world = pairs.world_from_root().inverse();
  std::vector<MechanismBody> bodies;
  std::vector<MechanismObstacle> obstacles;
  std::vector<MechanismPair> tested;
  std::vector<std::size_t> indices;  // of these, in BodyPairs
  bool has_meshes = false;
  std::vector<int> body_of_piece(pairs.pieces().size(), -1);
  std::vector<int> obstacle_at(pairs.obstacles().size(), -1);
  for (std::size_t i = pairs.static_tree_pairs_begin(); i < pairs.pairs().size(); ++i) {
    const CheckedPair& pair = pairs.pairs()[i];
    const auto index = static_cast<std::size_t>(pair.piece);
    const CheckedPiece& piece = pairs.pieces()[index];
    const auto link = static_cast<std::size_t>(piece.link);
    int& place = obstacle_at[static_cast<std::size_t>(pair.other)];
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
      always_ = always_ || pairs.touches(i, at_zero);
      continue;
    }
    if (body_of_piece[index] < 0) {
      body_of_piece[index] = static_cast<int>(bodies_.size());
      bodies_.push_back(body);
      bodies.push_back({body.frame, body.frame_from_link, piece.tree});
    }
    tested.push_back({body_of_piece[index], place});
    indices.push_back(i);
  }
  pair_of_.resize(bodies_.size() * obstacles_.size());
  for (std::size_t i = 0; i < tested.size(); ++i) pair_of_[place_of(tested[i])] = indices[i];
  check_ = std::make_unique<const MechanismCheck>(
      frames.frames, bodies, obstacles, tested, pairs.pose_error(),
      MechanismCheckOptions{.instructions = instructions, .always_exact = has_meshes});
}

bool StaticTrees::touch(std::span<const double> configuration, Memory& memory) const {
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

void StaticTrees::find_free(std::span<const double> configurations, Memory& memory,
                            std::span<std::uint8_t> free) const {
  constexpr std::size_t kBlock = MechanismCheck::kBlock;
  const auto variables = static_cast<std::size_t>(pairs_.robot().variable_count());
  const auto configuration = [&](std::size_t i) {
    return configurations.subspan(i * variables, variables);
  };
  for (std::size_t first = 0; first < free.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, free.size()) - 1;
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
          const std::size_t queried = std::min(first + static_cast<std::size_t>(index), last);
          const bool touch = touches(configuration(queried), contact, is_placed, memory);
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
      free[i] = hit ? 0 : 1;
    }
  }
}

StaticTrees::AlongFinding StaticTrees::check_along(std::span<const double> from,
                                                   std::span<const double> to, bool needs_contact,
                                                   Memory& memory) const {
  if (always_) return AlongFinding::kUndecided;
  const std::optional<bool> is_free = check_->is_free_along(
      positions_.of(from, memory.room_, 0), positions_.of(to, memory.room_, 1), memory.check_);
  if (is_free.value_or(false)) return AlongFinding::kFree;
  if (!is_free || !needs_contact) return AlongFinding::kUndecided;
  memory.middle_.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) memory.middle_[i] = 0.5 * from[i] + 0.5 * to[i];
  return touch(memory.middle_, memory) ? AlongFinding::kTouchesInTheMiddle
                                       : AlongFinding::kUndecided;
}

// Whether the robot touches an obstacle at the contact, or where it last did. `is_placed` says
// whether the memory holds the configuration's poses.
bool StaticTrees::touches(std::span<const double> configuration, const MechanismContact& contact,
                          bool& is_placed, Memory& memory) const {
  if (!std::exchange(is_placed, true)) {
    pairs_.place(configuration, memory.placed_);
    if (memory.last_ && still_touches(*memory.last_, memory)) return true;
  }
  const bool is_known =
      std::any_of(memory.unconfirmed_.begin(), memory.unconfirmed_.end(), [&](const auto& pair) {
        return pair.body == contact.pair.body && pair.obstacle == contact.pair.obstacle;
      });
  if (is_known && !are_meshes(contact.pair)) return false;
  const Finding finding = find(contact, memory);
  if (finding == Finding::kSpheres && !is_known) memory.unconfirmed_.push_back(contact.pair);
  return finding == Finding::kTouch;
}

// The canonical test of the spheres, and that of the meshes; the latter is for a body and an
// obstacle as a whole unless both are meshes.
StaticTrees::Finding StaticTrees::find(const MechanismContact& contact, Memory& memory) const {
  const Body& body = body_of(contact.pair);
  const Obstacle& obstacle = obstacle_of(contact.pair);
  const Pose& world_from_body = pose_of(body, memory);
  if (body.piece->mesh != nullptr && obstacle.mesh == nullptr) {
    // One triangle often tells, and if it is deep in the sphere, both tests would agree.
    const auto [triangle, depth] =
        nearest_triangle(*body.piece->mesh, contact.body_sphere, world_from_body, *obstacle.tree,
                         contact.obstacle_sphere, obstacle.world_from_tree);
    if (depth > 0.0) {
      memory.last_ = {contact, {triangle, contact.obstacle_sphere}};
      if (check_->is_following(memory.check_)) remember(*memory.last_, depth, memory);
      return Finding::kTouch;
    }
  }
  if (!spheres_touch(*body.piece->tree, contact.body_sphere, world_from_body, *obstacle.tree,
                     contact.obstacle_sphere, obstacle.world_from_tree)) {
    return Finding::kApart;
  }
  if (!are_meshes(contact.pair)) {
    const std::size_t pair = pair_of(contact.pair);
    const bool touch =
        !pairs_.is_confirmed(pairs_.pairs()[pair]) || pairs_.meshes_touch(pair, memory.placed_);
    return touch ? Finding::kTouch : Finding::kSpheres;
  }
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
// Where the depth at the former triangles proves nothing, two meshes are tested at the spheres
// above those; after that, the contact that the MechanismCheck wants confirmed decides.
bool StaticTrees::still_touches(const Touch& touch, Memory& memory) const {
  if (check_->is_following(memory.check_)) {
    const double depth = depth_of(touch, memory);
    if (depth > 0.0) {
      remember(touch, depth, memory);
      return true;
    }
  }
  return are_meshes(touch.contact.pair) && find(touch.contact, memory) == Finding::kTouch;
}

double StaticTrees::depth_of(const Touch& touch, const Memory& memory) const {
  const Body& body = body_of(touch.contact.pair);
  const Obstacle& obstacle = obstacle_of(touch.contact.pair);
  return obstacle.mesh != nullptr
             ? contact_depth(*body.piece->mesh, pose_of(body, memory), *obstacle.mesh,
                             obstacle.world_from_tree, touch.triangles)
             : contact_depth(*body.piece->mesh, touch.triangles.a, pose_of(body, memory),
                             *obstacle.tree, touch.triangles.b, obstacle.world_from_tree);
}

// The poses of forward_kinematics() are within pose_error() of those of the exact mechanism, now
// and at any configuration for which the MechanismCheck reuses the contact; as much again covers
// the error of the sphere that it remembers.
void StaticTrees::remember(const Touch& touch, double depth, Memory& memory) const {
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
bool StaticTrees::contains_component(const Memory& memory) const {
  return std::any_of(
      memory.unconfirmed_.begin(), memory.unconfirmed_.end(), [&](const MechanismPair& pair) {
        if (!are_meshes(pair)) return false;
        const Body& body = body_of(pair);
        const Obstacle& obstacle = obstacle_of(pair);
        return spherule::contains_component(*body.piece->mesh, pose_of(body, memory),
                                            *obstacle.mesh, obstacle.world_from_tree);
      });
}

bool StaticTrees::touch_exactly(std::span<const double> configuration, Memory& memory) const {
  pairs_.place(configuration, memory.placed_);
  for (std::size_t i = pairs_.static_tree_pairs_begin(); i < pairs_.pairs().size(); ++i) {
    if (pairs_.touches(i, memory.placed_)) return true;
  }
  return false;
}

}  // namespace spherule::internal
