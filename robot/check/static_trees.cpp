// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/static_trees.h"

#include "base/rounding.h"
#include "collide/collide.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace spherule::internal {

StaticTrees::StaticTrees(const BodyPairs& pairs, InstructionSet instructions)
    : pairs_(pairs), positions_(pairs.robot()) {
  const RobotModel& robot = pairs.robot();
  const MovingFrames frames(robot);
  BodyPairs::Scratch at_zero;
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
      has_static_contact_ = has_static_contact_ || pairs.touches(i, at_zero);
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

bool StaticTrees::touch(std::span<const double> configuration, Scratch& scratch) const {
  const std::span<const double> positions = positions_.of(configuration, scratch.positions_);
  if (!MechanismCheck::is_in_range(positions)) return touch_exactly(configuration, scratch);
  if (has_static_contact_) return true;
  bool is_placed = false;
  scratch.unconfirmed_.clear();
  const auto confirm = [&](const MechanismContact& contact) {
    return touches(configuration, contact, is_placed, scratch);
  };
  return check_->collides(positions, scratch.check_, confirm) || contains_component(scratch);
}

void StaticTrees::find_free(std::span<const double> configurations, Scratch& scratch,
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
      block[i] = positions_.of(configuration(index), scratch.positions_, i).data();
    }
    int placed = -1;
    std::uint32_t unconfirmed = 0;
    const MechanismCheck::BlockAnswer answer =
        check_->collides(block, scratch.check_, [&](int index, const MechanismContact& contact) {
          bool is_placed = std::exchange(placed, index) == index;
          scratch.unconfirmed_.clear();
          const std::size_t queried = std::min(first + static_cast<std::size_t>(index), last);
          const bool touch = touches(configuration(queried), contact, is_placed, scratch);
          if (!scratch.unconfirmed_.empty()) unconfirmed |= 1U << index;
          return touch;
        });
    for (std::size_t i = first; i <= last; ++i) {
      const auto says = [&](std::uint32_t bits) { return (bits >> (i - first) & 1U) != 0; };
      bool hit = has_static_contact_ || says(answer.collides);
      if (says(answer.out_of_range)) {
        hit = touch_exactly(configuration(i), scratch);
      } else if (!hit && says(unconfirmed)) {
        hit = touch(configuration(i), scratch);
      }
      free[i] = hit ? 0 : 1;
    }
  }
}

StaticTrees::AlongFinding StaticTrees::check_along(std::span<const double> from,
                                                   std::span<const double> to, bool needs_contact,
                                                   Scratch& scratch) const {
  if (has_static_contact_) return AlongFinding::kUndecided;
  const std::optional<bool> is_free =
      check_->is_free_along(positions_.of(from, scratch.positions_, 0),
                            positions_.of(to, scratch.positions_, 1), scratch.check_);
  if (is_free.value_or(false)) return AlongFinding::kFree;
  if (!is_free || !needs_contact) return AlongFinding::kUndecided;
  scratch.middle_.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) scratch.middle_[i] = 0.5 * from[i] + 0.5 * to[i];
  return touch(scratch.middle_, scratch) ? AlongFinding::kTouchesInTheMiddle
                                         : AlongFinding::kUndecided;
}

// Whether the robot touches an obstacle at the contact, or where it last did. `is_placed` says
// whether the scratch holds the configuration's poses.
bool StaticTrees::touches(std::span<const double> configuration, const MechanismContact& contact,
                          bool& is_placed, Scratch& scratch) const {
  if (!std::exchange(is_placed, true)) {
    pairs_.place(configuration, scratch.placed_);
    if (scratch.last_ && still_touches(*scratch.last_, scratch)) return true;
  }
  const bool is_known =
      std::any_of(scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), [&](const auto& pair) {
        return pair.body == contact.pair.body && pair.obstacle == contact.pair.obstacle;
      });
  if (is_known && !are_meshes(contact.pair)) return false;
  const Finding finding = find(contact, scratch);
  if (finding == Finding::kSpheres && !is_known) scratch.unconfirmed_.push_back(contact.pair);
  return finding == Finding::kTouch;
}

// The canonical test of the spheres, and that of the meshes; the latter is for a body and an
// obstacle as a whole unless both are meshes.
StaticTrees::Finding StaticTrees::find(const MechanismContact& contact, Scratch& scratch) const {
  const Body& body = body_of(contact.pair);
  const Obstacle& obstacle = obstacle_of(contact.pair);
  const Pose& world_from_body = pose_of(body, scratch);
  if (body.piece->mesh != nullptr && obstacle.mesh == nullptr) {
    // One triangle often tells, and if it is deep in the sphere, both tests would agree.
    const auto [triangle, depth] =
        nearest_triangle(*body.piece->mesh, contact.body_sphere, world_from_body, *obstacle.tree,
                         contact.obstacle_sphere, obstacle.world_from_tree);
    if (depth > 0.0) {
      scratch.last_ = {contact, {triangle, contact.obstacle_sphere}};
      if (check_->is_following(scratch.check_)) remember(*scratch.last_, depth, scratch);
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
        !pairs_.is_confirmed(pairs_.pairs()[pair]) || pairs_.meshes_touch(pair, scratch.placed_);
    return touch ? Finding::kTouch : Finding::kSpheres;
  }
  const std::optional<TrianglePair> triangles =
      touching_triangles(*body.piece->mesh, contact.body_sphere, world_from_body, *obstacle.mesh,
                         contact.obstacle_sphere, obstacle.world_from_tree);
  if (!triangles) return Finding::kSpheres;
  scratch.last_ = {contact, *triangles};
  if (check_->is_following(scratch.check_)) {
    remember(*scratch.last_, depth_of(*scratch.last_, scratch), scratch);
  }
  return Finding::kTouch;
}

// A robot that touches often did so a moment ago, by the same triangles or by others near to them.
// Where the depth at the former triangles proves nothing, two meshes are tested at the spheres
// above those; after that, the contact that the MechanismCheck wants confirmed decides.
bool StaticTrees::still_touches(const Touch& touch, Scratch& scratch) const {
  if (check_->is_following(scratch.check_)) {
    const double depth = depth_of(touch, scratch);
    if (depth > 0.0) {
      remember(touch, depth, scratch);
      return true;
    }
  }
  return are_meshes(touch.contact.pair) && find(touch.contact, scratch) == Finding::kTouch;
}

double StaticTrees::depth_of(const Touch& touch, const Scratch& scratch) const {
  const Body& body = body_of(touch.contact.pair);
  const Obstacle& obstacle = obstacle_of(touch.contact.pair);
  return obstacle.mesh != nullptr
             ? contact_depth(*body.piece->mesh, pose_of(body, scratch), *obstacle.mesh,
                             obstacle.world_from_tree, touch.triangles)
             : contact_depth(*body.piece->mesh, touch.triangles.a, pose_of(body, scratch),
                             *obstacle.tree, touch.triangles.b, obstacle.world_from_tree);
}

// The poses of forward_kinematics() are within pose_error() of those of the exact mechanism, now
// and at any configuration for which the MechanismCheck reuses the contact; as much again covers
// the error of the sphere that it remembers.
void StaticTrees::remember(const Touch& touch, double depth, Scratch& scratch) const {
  if (depth <= 3.0 * pairs_.pose_error()) return;
  const Body& body = body_of(touch.contact.pair);
  const auto& [p, q, r] = body.piece->mesh->mesh().triangle(touch.triangles.a);
  const Eigen::Vector3d center = (p + q + r) / 3.0;
  const double radius =
      std::max({distance_upper(center, p), distance_upper(center, q), distance_upper(center, r)});
  check_->remember_contact(body.frame, {body.frame_from_link * center, radius},
                           depth - 3.0 * pairs_.pose_error(), scratch.check_);
}

// Where no triangles touch but spheres do, under the poses that the scratch holds.
bool StaticTrees::contains_component(const Scratch& scratch) const {
  return std::any_of(
      scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), [&](const MechanismPair& pair) {
        if (!are_meshes(pair)) return false;
        const Body& body = body_of(pair);
        const Obstacle& obstacle = obstacle_of(pair);
        return spherule::contains_component(*body.piece->mesh, pose_of(body, scratch),
                                            *obstacle.mesh, obstacle.world_from_tree);
      });
}

bool StaticTrees::touch_exactly(std::span<const double> configuration, Scratch& scratch) const {
  pairs_.place(configuration, scratch.placed_);
  for (std::size_t i = pairs_.static_tree_pairs_begin(); i < pairs_.pairs().size(); ++i) {
    if (pairs_.touches(i, scratch.placed_)) return true;
  }
  return false;
}

}  // namespace spherule::internal
