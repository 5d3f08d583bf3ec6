// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Pairs of spheres on links, and of spheres and static solids, in double precision: the canonical
// tests of a RobotChecker. Its proofs are in body_pairs.cpp.
//
// Confirmation. Where the mesh of one side is known, it stands in the place of the spheres that
// cover it, with its inside and the padding around it: the two touch if their spheres do and the
// mesh touches the other side (its mesh, spheres, or solid). No contact is lost, because a padded
// mesh lies in its padded cover.

#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/meshes/mesh_contact.h"
#include "robot/check/robot_scene.h"
#include "robot/model/link_paths.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Spheres on a link that are tested as one: a tree of a link or an attached object, or some of its
// spheres, grown by the padding that is requested.
struct CheckedPiece {
  std::shared_ptr<const SphereTree> tree;
  int link = 0;                         // that carries it
  std::size_t body = 0;                 // whose spheres they are
  std::size_t body_tree = 0;            // of which tree of the body
  std::vector<std::int32_t> spheres{};  // which of them; empty: all
  double padding = 0.0;
  // The body's mesh without the padding, if contacts are to be confirmed on it.
  std::shared_ptr<const CoveredMesh> mesh{};
};

struct PlacedShape {
  ObstacleShape shape;
  Pose world_from_shape;
  std::shared_ptr<const CoveredMesh> mesh{};  // as above, of a tree
};

// A piece and another, or a piece and an obstacle.
struct CheckedPair {
  int piece = 0;
  int other = 0;
  bool is_obstacle = false;
  // Where the two are proved free, whatever their spheres say. Null: nowhere.
  std::shared_ptr<const FreeBoxes> boxes{};
};

// The spheres that overlap deepest, or the sphere and the solid (then `other_sphere` is -1 unless
// that is a tree). Indices into the trees of the pieces.
struct PairContact {
  std::int32_t sphere = -1;
  std::int32_t other_sphere = -1;
  double overlap_depth = 0.0;
  Eigen::Vector3d world_point = Eigen::Vector3d::Zero();
};

class BodyPairs {
 public:
  // Pairs from `static_tree_pairs_begin` on are of pieces and static sphere trees: configurations
  // test them through StaticTrees, motions through LaneCheck with all others. Indices must be in
  // range. Throws Error for what reaches beyond kMaxCoordinate.
  BodyPairs(RobotModel robot, const Pose& world_from_root, std::vector<CheckedPiece> pieces,
            std::vector<PlacedShape> obstacles, std::vector<CheckedPair> pairs,
            std::size_t static_tree_pairs_begin);

  // What the functions below write to.
  struct Scratch {
    std::vector<double> configuration{};
    std::vector<Pose> world_from_link{};
    std::vector<Sphere> placed{};  // root spheres of the pieces, in the world, up to pad
    double pad = 0.0;
    std::size_t last = 0;  // the pair that touched last
  };

  const std::vector<CheckedPiece>& pieces() const { return pieces_; }
  const std::vector<PlacedShape>& obstacles() const { return obstacles_; }
  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  std::size_t static_tree_pairs_begin() const { return static_tree_pairs_begin_; }
  const RobotModel& robot() const { return robot_; }
  const Pose& world_from_root() const { return world_from_root_; }
  // From a piece to the root; of a pair: the joints between its two sides.
  const PathReach& path_to_root(std::size_t piece) const { return paths_[piece]; }
  const PathReach& path(std::size_t pair) const { return paths_[path_of_[pair]]; }
  // Whether the mesh of a side is known.
  bool is_confirmed(const CheckedPair& pair) const;

  // Whether the bounds of errors hold: every number is finite, and no joint's position is beyond
  // kLargestJointPosition. For a configuration of the right size.
  bool in_filter_range(std::span<const double> configuration) const;

  // Takes a configuration; the functions below answer for it. Throws Error as forward_kinematics().
  void place(std::span<const double> configuration, Scratch& scratch) const;

  // By the canonical tests, which find nothing where the pair is proved free.
  bool touches(std::size_t pair, const Scratch& scratch) const;
  // Of the pairs before static_tree_pairs_begin().
  bool any_touches(Scratch& scratch) const;
  // Whether a pair is proved free in the configuration that was taken.
  bool is_proved_free(std::size_t pair, const Scratch& scratch) const {
    const FreeBoxes* const boxes = pairs_[pair].boxes.get();
    return boxes != nullptr && boxes->contains(scratch.configuration);
  }
  // Of a pair that is_confirmed() and whose spheres touch: touches().
  bool meshes_touch(std::size_t pair, const Scratch& scratch) const {
    return meshes_within(pairs_[pair], 0.0, scratch);
  }

  // Never false if the two are within the clearance of each other in exact arithmetic or, where no
  // mesh is queried, the canonical test finds them so.
  bool is_near(std::size_t pair, double clearance, const Scratch& scratch) const;

  // A lower bound of the exact gap of the spheres of a pair, found at once; -infinity if there is
  // none.
  double gap_bound(std::size_t pair, const Scratch& scratch) const;
  // Of the spheres, whatever is confirmed.
  DistanceResult distance(std::size_t pair, const Scratch& scratch,
                          const DistanceRequest& request) const;
  // None exactly if touches() is false, where the pair is not proved free; there the spheres
  // decide, unless meshes confirm them.
  std::optional<PairContact> deepest_contact(std::size_t pair, const Scratch& scratch) const;

  // How far any point of a link may be from where the exact mechanism has it.
  double pose_error() const { return pose_error_; }
  // How far any point may be from where it is at the middle of a part of a motion, because that
  // configuration is rounded.
  double middle_error() const { return middle_error_; }

 private:
  const Pose& pose_of(const CheckedPiece& piece, const Scratch& scratch) const {
    return scratch.world_from_link[static_cast<std::size_t>(piece.link)];
  }
  double signed_distance(const CheckedPair& pair, const Scratch& scratch) const;
  bool spheres_apart(const CheckedPair& pair, double clearance, const Scratch& scratch) const;
  bool spheres_within(const CheckedPair& pair, double clearance, const Scratch& scratch) const;
  bool meshes_within(const CheckedPair& pair, double clearance, const Scratch& scratch) const;
  // True only if the solid is farther than `reach` from the sphere's centre in the world; the pad
  // is in it.
  bool is_beyond(std::size_t obstacle, const Eigen::Vector3d& center, double reach) const {
    const Sphere& sphere = solid_spheres_[obstacle];
    const double limit = sphere.radius + reach;
    return (center - sphere.center).squaredNorm() > limit * limit;
  }
  // Fills paths_ and path_of_; what stands still hangs on the root.
  void make_paths();

  RobotModel robot_;
  Pose world_from_root_;
  std::vector<CheckedPiece> pieces_;
  std::vector<PlacedShape> obstacles_;
  std::vector<CheckedPair> pairs_;
  std::size_t static_tree_pairs_begin_;
  std::vector<Sphere> solid_spheres_;  // in the world, around each primitive; else of infinite size
  double size_ = 0.0;                  // bounds all coordinates while in_filter_range()
  double pose_error_ = 0.0;
  double middle_error_ = 0.0;
  std::vector<PathReach> paths_;      // of pieces to the root, then of pairs of pieces
  std::vector<std::size_t> path_of_;  // of each pair
};

// The configuration at a fraction of a straight motion, rounded.
void take_between(std::span<const double> from, std::span<const double> to, double at,
                  std::vector<double>& configuration);

// Where on a straight motion pairs with boxes, by their indices, are proved free. The margin of
// FreeBoxes is for the rounding of the ends of parts. For one motion after the other.
class EdgeProofs {
 public:
  // `pairs` must outlive it.
  explicit EdgeProofs(const BodyPairs& pairs);

  // Takes a motion, whose ends are kept until the next one.
  void take(std::span<const double> from, std::span<const double> to);

  // At a fraction of it.
  bool is_free_at(std::size_t pair, double at);
  // Everywhere; looked up once.
  bool is_free(std::size_t pair);
  // Those of the lanes in which it is all the way from `half` before to `half` behind `middle`.
  template <std::size_t N>
  unsigned free_parts(std::size_t pair, const std::array<double, N>& middle,
                      const std::array<double, N>& half, unsigned lanes) {
    const FreeBoxes& boxes = boxes_of(pair);
    unsigned free = 0;
    for (std::size_t lane = 0; lane < N; ++lane) {
      if ((lanes >> lane & 1U) == 0) continue;
      take_between(from_, to_, middle[lane] - half[lane], begin_);
      take_between(from_, to_, middle[lane] + half[lane], end_);
      if (boxes.contains_edge(begin_, end_)) free |= 1U << lane;
    }
    return free;
  }

 private:
  const FreeBoxes& boxes_of(std::size_t pair) const { return *pairs_.pairs()[pair].boxes; }

  const BodyPairs& pairs_;
  std::span<const double> from_{};
  std::span<const double> to_{};
  std::vector<double> begin_;
  std::vector<double> end_;
  std::vector<std::int8_t> is_free_;  // of each pair; -1: not known yet
};

}  // namespace spherule::internal
