// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/static_trees.h"

#include "base/rounding.h"
#include "collide/collide.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace spherule::internal {

StaticTrees::StaticTrees(const BodyPairs& pairs, const RobotPlanSource& source,
                         InstructionSet instructions)
    : pairs_(pairs),
      positions_(pairs.robot()),
      pair_of_test_(source.pair_of_test),
      check_(source.source, source.first_static_tree, instructions) {
  BodyPairs::Scratch at_zero;
  pairs.place(std::vector<double>(static_cast<std::size_t>(pairs.robot().variable_count())),
              at_zero);
  has_static_contact_ =
      std::any_of(source.fixed_pairs.begin(), source.fixed_pairs.end(), [&](std::size_t pair) {
        return pair >= pairs.static_tree_pairs_begin() && pairs.touches(pair, at_zero);
      });
}

bool StaticTrees::touch(std::span<const double> configuration, Scratch& scratch) const {
  const std::span<const double> positions = positions_.of(configuration, scratch.positions_);
  if (!TreeCheck::is_in_range(positions)) return touch_exactly(configuration, scratch);
  if (has_static_contact_) return true;
  bool is_placed = false;
  scratch.unconfirmed_.clear();
  const auto confirm = [&](const TreeContact& contact) {
    return touches(configuration, contact, is_placed, scratch);
  };
  return check_.collides(positions, scratch.check_, confirm) || contains_component(scratch);
}

void StaticTrees::find_free(std::span<const double> configurations, Scratch& scratch,
                            std::span<std::uint8_t> free) const {
  constexpr std::size_t kBlock = TreeCheck::kBlock;
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
    const KernelBlockAnswer answer =
        check_.collides(block, scratch.check_, [&](int index, const TreeContact& contact) {
          bool is_placed = std::exchange(placed, index) == index;
          scratch.unconfirmed_.clear();
          const std::size_t queried = std::min(first + static_cast<std::size_t>(index), last);
          const bool touch = touches(configuration(queried), contact, is_placed, scratch);
          if (!scratch.unconfirmed_.empty()) unconfirmed |= 1U << index;
          return touch;
        });
    for (std::size_t i = first; i <= last; ++i) {
      const auto says = [&](std::uint32_t bits) { return (bits >> (i - first) & 1U) != 0; };
      bool hit = has_static_contact_ || says(answer.hits);
      if (says(answer.refused)) {
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
      check_.is_free_along(positions_.of(from, scratch.positions_, 0),
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
bool StaticTrees::touches(std::span<const double> configuration, const TreeContact& contact,
                          bool& is_placed, Scratch& scratch) const {
  if (!std::exchange(is_placed, true)) {
    pairs_.place(configuration, scratch.placed_);
    if (scratch.last_ && still_touches(*scratch.last_, scratch)) return true;
  }
  const std::size_t pair = pair_of(contact);
  const bool is_known = std::find(scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), pair) !=
                        scratch.unconfirmed_.end();
  if (is_known && !are_meshes(pair)) return false;
  const Finding finding = find(contact, scratch);
  if (finding == Finding::kSpheres && !is_known) scratch.unconfirmed_.push_back(pair);
  return finding == Finding::kTouch;
}

// The canonical test of the spheres, and that of the meshes; the latter is for a body and an
// obstacle as a whole unless both are meshes.
StaticTrees::Finding StaticTrees::find(const TreeContact& contact, Scratch& scratch) const {
  const std::size_t pair = pair_of(contact);
  const CheckedPiece& piece = piece_of(pair);
  const PlacedShape& obstacle = obstacle_of(pair);
  const Pose& world_from_piece = pose_of(piece, scratch);
  if (piece.mesh != nullptr && obstacle.mesh == nullptr) {
    // One triangle often tells, and if it is deep in the sphere, both tests would agree.
    const auto [triangle, depth] =
        nearest_triangle(*piece.mesh, contact.body_sphere, world_from_piece, tree_of(obstacle),
                         contact.obstacle_sphere, obstacle.world_from_shape);
    if (depth > 0.0) {
      scratch.last_ = {contact, {triangle, contact.obstacle_sphere}};
      if (check_.is_following(scratch.check_)) remember(*scratch.last_, depth, scratch);
      return Finding::kTouch;
    }
  }
  if (!spheres_touch(*piece.tree, contact.body_sphere, world_from_piece, tree_of(obstacle),
                     contact.obstacle_sphere, obstacle.world_from_shape)) {
    return Finding::kApart;
  }
  if (!are_meshes(pair)) {
    const bool touch =
        !pairs_.is_confirmed(pairs_.pairs()[pair]) || pairs_.meshes_touch(pair, scratch.placed_);
    return touch ? Finding::kTouch : Finding::kSpheres;
  }
  const std::optional<TrianglePair> triangles =
      touching_triangles(*piece.mesh, contact.body_sphere, world_from_piece, *obstacle.mesh,
                         contact.obstacle_sphere, obstacle.world_from_shape);
  if (!triangles) return Finding::kSpheres;
  scratch.last_ = {contact, *triangles};
  if (check_.is_following(scratch.check_)) {
    remember(*scratch.last_, depth_of(*scratch.last_, scratch), scratch);
  }
  return Finding::kTouch;
}

// A robot that touches often did so a moment ago, by the same triangles or by others near to them.
// Where the depth at the former triangles proves nothing, two meshes are tested at the spheres
// above those; after that, the contact that the TreeCheck wants confirmed decides.
bool StaticTrees::still_touches(const Touch& touch, Scratch& scratch) const {
  if (check_.is_following(scratch.check_)) {
    const double depth = depth_of(touch, scratch);
    if (depth > 0.0) {
      remember(touch, depth, scratch);
      return true;
    }
  }
  return are_meshes(pair_of(touch.contact)) && find(touch.contact, scratch) == Finding::kTouch;
}

double StaticTrees::depth_of(const Touch& touch, const Scratch& scratch) const {
  const std::size_t pair = pair_of(touch.contact);
  const CheckedPiece& piece = piece_of(pair);
  const PlacedShape& obstacle = obstacle_of(pair);
  const Pose& pose = pose_of(piece, scratch);
  return obstacle.mesh != nullptr
             ? contact_depth(*piece.mesh, pose, *obstacle.mesh, obstacle.world_from_shape,
                             touch.triangles)
             : contact_depth(*piece.mesh, touch.triangles.a, pose, tree_of(obstacle),
                             touch.triangles.b, obstacle.world_from_shape);
}

// The poses of forward_kinematics() are within pose_error() of those of the exact mechanism, now
// and at any configuration for which the TreeCheck reuses the contact; as much again covers
// the error of the sphere that it remembers.
void StaticTrees::remember(const Touch& touch, double depth, Scratch& scratch) const {
  if (depth <= 3.0 * pairs_.pose_error()) return;
  const CoveredMesh& mesh = *piece_of(pair_of(touch.contact)).mesh;
  const auto& [p, q, r] = mesh.mesh().triangle(touch.triangles.a);
  const Eigen::Vector3d center = (p + q + r) / 3.0;
  const double radius =
      std::max({distance_upper(center, p), distance_upper(center, q), distance_upper(center, r)});
  check_.remember_contact(touch.contact.test, {center, radius}, depth - 3.0 * pairs_.pose_error(),
                          scratch.check_);
}

// Where no triangles touch but spheres do, under the poses that the scratch holds.
bool StaticTrees::contains_component(const Scratch& scratch) const {
  return std::any_of(
      scratch.unconfirmed_.begin(), scratch.unconfirmed_.end(), [&](std::size_t pair) {
        if (!are_meshes(pair)) return false;
        const CheckedPiece& piece = piece_of(pair);
        const PlacedShape& obstacle = obstacle_of(pair);
        return spherule::contains_component(*piece.mesh, pose_of(piece, scratch), *obstacle.mesh,
                                            obstacle.world_from_shape);
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
