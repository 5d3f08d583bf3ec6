// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Configurations against sphere trees that stand still: a TreeCheck, whose cache of the last
// configurations makes a path fast, with the exact tests.

#include "collide/kernels/tree_check.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/search/instruction_set.h"
#include "robot/check/body_pairs.h"
#include "robot/check/plan_source.h"
#include "robot/model/joint_positions.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace spherule::internal {

// Of the pairs of BodyPairs from static_tree_pairs_begin() on, does any touch? Exactly
// BodyPairs::touches(): no instruction set changes an answer. The pairs are of pieces and sphere
// trees.
class StaticTrees {
 private:
  // A contact that was confirmed: by a triangle of the piece's mesh and one of the obstacle's, or
  // where that has no mesh, the obstacle's sphere.
  struct Touch {
    TreeContact contact;
    TrianglePair triangles;
  };

 public:
  // `pairs`, of which the source is made, must outlive it. Throws Error as TreeCheck does.
  StaticTrees(const BodyPairs& pairs, const RobotPlanSource& source, InstructionSet instructions);

  // What a query writes to. Those of several threads share no cache line.
  class alignas(64) Scratch {
   public:
    // For these.
    explicit Scratch(const StaticTrees& trees)
        : check_(trees.check_), positions_(trees.positions_.scratch_for(TreeCheck::kBlock)) {}

   private:
    friend class StaticTrees;
    TreeCheck::Scratch check_;
    BodyPairs::Scratch placed_{};
    std::vector<double> middle_{};
    std::vector<std::size_t> unconfirmed_{};  // pairs whose spheres touch, but not the meshes
    std::optional<Touch> last_{};
    JointPositions::Scratch positions_;
  };

  // Fastest where each configuration is near the one before: the scratch then knows how far the
  // robot was from everything, or how deep in it. The configuration has as many numbers as the
  // robot has variables; throws Error if one is not finite, and where forward_kinematics() does.
  bool touch(std::span<const double> configuration, Scratch& scratch) const;

  // The same of many, which lie one behind the other: free[i] is 1 if the i-th touches nothing,
  // otherwise 0. Several times faster where neighbours differ little.
  void find_free(std::span<const double> configurations, Scratch& scratch,
                 std::span<std::uint8_t> free) const;

  // Of a straight motion from one configuration to another: whether it is free, as RobotChecker
  // says of check_edge(), or (if that is requested) touches in its middle. Fast for the motions of
  // a path, one after the other; undecided where that is not known soon. Both ends must be
  // BodyPairs::in_filter_range().
  enum class AlongFinding { kFree, kTouchesInTheMiddle, kUndecided };
  AlongFinding check_along(std::span<const double> from, std::span<const double> to,
                           bool needs_contact, Scratch& scratch) const;

 private:
  std::size_t pair_of(const TreeContact& contact) const {
    return pair_of_test_[static_cast<std::size_t>(contact.test)];
  }
  const CheckedPiece& piece_of(std::size_t pair) const {
    return pairs_.pieces()[static_cast<std::size_t>(pairs_.pairs()[pair].piece)];
  }
  const PlacedShape& obstacle_of(std::size_t pair) const {
    return pairs_.obstacles()[static_cast<std::size_t>(pairs_.pairs()[pair].other)];
  }
  static const SphereTree& tree_of(const PlacedShape& obstacle) {
    return *std::get<std::shared_ptr<const SphereTree>>(obstacle.shape);
  }
  static const Pose& pose_of(const CheckedPiece& piece, const Scratch& scratch) {
    return scratch.placed_.world_from_link[static_cast<std::size_t>(piece.link)];
  }
  // Whether two meshes without padding stand for the two: contacts are then confirmed sphere by
  // sphere, on the triangles under them.
  bool are_meshes(std::size_t pair) const {
    const CheckedPiece& piece = piece_of(pair);
    return piece.mesh != nullptr && obstacle_of(pair).mesh != nullptr && piece.padding == 0.0;
  }

  enum class Finding { kApart, kSpheres, kTouch };
  Finding find(const TreeContact& contact, Scratch& scratch) const;
  bool still_touches(const Touch& touch, Scratch& scratch) const;
  double depth_of(const Touch& touch, const Scratch& scratch) const;
  void remember(const Touch& touch, double depth, Scratch& scratch) const;
  bool touches(std::span<const double> configuration, const TreeContact& contact, bool& is_placed,
               Scratch& scratch) const;
  bool contains_component(const Scratch& scratch) const;
  bool touch_exactly(std::span<const double> configuration, Scratch& scratch) const;

  const BodyPairs& pairs_;
  JointPositions positions_;
  std::vector<std::size_t> pair_of_test_;
  bool has_static_contact_ = false;  // of a piece that stands with the root
  TreeCheck check_;
};

}  // namespace spherule::internal
