// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/body_pairs.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/collide.h"
#include "collide/kernels/check_plan_source.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/shapes.h"
#include "collide/solids/solid_fields.h"
#include "robot/model/kinematics.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

// Root spheres. Let W bound |p| + |t| of the centre p of a root sphere in its frame and the pose's
// translation t, and all that a sphere reaches from the world's origin. A placed centre errs by
// 40 u W (pose.h), so that the computed distance of two is within 90 u W of the exact one, with
// roundings. What a canonical test accepts is at most collision_slack() apart: 152 u of the scene,
// at most 152 u (2 W + 1.74 * 2 W) < 840 u W. So two whose spheres are further apart than the
// radii, the clearance and kSpherePad W touch for no canonical test, and their exact gap is at
// least the computed one less that. For primitives primitive_slack() is 304 u of the scene, below
// 1700 u W; the image of a placed centre in the solid's frame errs by less than 40 u + 70 u of 2 W
// more, and the distance computed there by less than 8 u of 3 W: twice kSpherePad.

namespace spherule::internal {
namespace {

// Each takes some 100 bytes. Arms and hands have a few thousand.
constexpr std::size_t kMostSteps = std::size_t{1} << 24;

constexpr double kSpherePad = 1024.0 * kUnitRoundoff;

// How far any of the spheres of a tree, those of nodes included, reaches.
double reach_of(const SphereTree& tree) {
  return std::max(tree.reach(), tree.sphere(0).center.norm() + tree.sphere(0).radius);
}

struct SizeOf {
  double operator()(const std::shared_ptr<const SphereTree>& tree) const { return reach_of(*tree); }
  double operator()(const std::shared_ptr<const SolidMesh>& mesh) const {
    return reach_of(mesh->mesh().tree()) + mesh->inflation();
  }
  double operator()(const Primitive& primitive) const { return std::visit(*this, primitive); }
  double operator()(const Box& box) const { return box.size.norm(); }
  double operator()(const SolidSphere& sphere) const { return sphere.radius; }
  double operator()(const Cylinder& solid) const { return solid.radius + solid.length; }
  double operator()(const Capsule& solid) const { return solid.radius + solid.length; }
  double operator()(const HalfSpace&) const { return 0.0; }
};

// The radius of a sphere around the origin of the shape's frame that holds all of it.
struct RadiusOf {
  double operator()(const std::shared_ptr<const SphereTree>&) const { return kUnbounded; }
  double operator()(const std::shared_ptr<const SolidMesh>&) const { return kUnbounded; }
  double operator()(const Primitive& primitive) const { return std::visit(*this, primitive); }
  double operator()(const Box& box) const { return kUp * 0.5 * box.size.norm(); }
  double operator()(const SolidSphere& sphere) const { return sphere.radius; }
  double operator()(const Cylinder& solid) const {
    return kUp * std::hypot(solid.radius, 0.5 * solid.length);
  }
  double operator()(const Capsule& solid) const {
    return kUp * (solid.radius + 0.5 * solid.length);
  }
  double operator()(const HalfSpace&) const { return kUnbounded; }

  static constexpr double kUp = 1.0 + 1e-12;
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();
};

// Calls `function` with the shape as the queries take it.
template <class Function>
auto with_shape(const PlacedShape& placed, Function function) {
  return std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Primitive>) {
          return function(shape);
        } else {
          return function(*shape);
        }
      },
      placed.shape);
}

double largest_reach(const RobotModel& robot, std::span<const CheckedPiece> pieces) {
  double reach = 0.0;
  for (const CheckedPiece& piece : pieces) reach = std::max(reach, reach_of(*piece.tree));
  for (const Link& link : robot.links()) {
    for (const auto& tree : link.trees) reach = std::max(reach, reach_of(*tree));
  }
  return reach;
}

// With all joints at zero; the root at the origin.
std::vector<Pose> poses_at_zero(const RobotModel& robot) {
  std::vector<Pose> poses(robot.links().size());
  for (const Joint& joint : robot.joints()) {
    poses[static_cast<std::size_t>(joint.child_link)] =
        poses[static_cast<std::size_t>(joint.parent_link)] * joint.parent_from_joint;
  }
  return poses;
}

}  // namespace

BodyPairs::BodyPairs(RobotModel robot, const Pose& world_from_root,
                     std::vector<CheckedPiece> pieces, std::vector<PlacedShape> obstacles,
                     std::vector<CheckedPair> pairs, std::size_t static_tree_pairs_begin)
    : robot_(std::move(robot)),
      world_from_root_(world_from_root),
      pieces_(std::move(pieces)),
      obstacles_(std::move(obstacles)),
      pairs_(std::move(pairs)),
      static_tree_pairs_begin_(static_tree_pairs_begin) {
  double scene = 0.0;
  for (const PlacedShape& obstacle : obstacles_) {
    scene = std::max(scene, obstacle.world_from_shape.translation().norm() +
                                std::visit(SizeOf(), obstacle.shape));
    solid_spheres_.push_back(
        {obstacle.world_from_shape.translation(), std::visit(RadiusOf(), obstacle.shape)});
  }
  const double reach = largest_reach(robot_, pieces_);
  const double root = world_from_root_.translation().norm();
  const MovingPoseError of_poses = moving_pose_error(robot_, reach, scene, root);
  pose_error_ = of_poses.error;
  size_ = of_poses.size;
  double factors = 0.0;
  for (const Joint& joint : robot_.joints()) {
    if (joint.moves()) factors += std::abs(joint.multiplier);
  }
  middle_error_ = factors * kMiddleError * std::max(2.0 * size_, 1.0);
  make_paths();
}

void BodyPairs::make_paths() {
  const std::vector<Pose> poses = poses_at_zero(robot_);
  std::size_t steps = 0;
  const auto joints_of = [&](int first, int second) {
    std::vector<int> joints = moving_joints(robot_, first, second);
    steps += joints.size();
    if (steps > kMostSteps) {
      throw Error("robot checker",
                  "too many joints lie between the bodies of its pairs: more than " +
                      std::to_string(kMostSteps) + " in all");
    }
    return joints;
  };
  for (const CheckedPiece& piece : pieces_) {
    paths_.emplace_back(robot_, poses, pose_error_, joints_of(piece.link, 0), piece.link,
                        piece.tree->sphere(0));
  }
  for (const CheckedPair& pair : pairs_) {
    if (pair.is_obstacle) {
      path_of_.push_back(static_cast<std::size_t>(pair.piece));
      continue;
    }
    const CheckedPiece& first = pieces_[static_cast<std::size_t>(pair.piece)];
    const CheckedPiece& second = pieces_[static_cast<std::size_t>(pair.other)];
    path_of_.push_back(paths_.size());
    paths_.emplace_back(robot_, poses, pose_error_, joints_of(first.link, second.link), first.link,
                        first.tree->sphere(0), second.link, second.tree->sphere(0));
  }
}

bool BodyPairs::in_filter_range(std::span<const double> configuration) const {
  if (!robot_.has_mimics()) {
    bool in_filter_range = true;
    for (const double position : configuration) {
      in_filter_range &= std::abs(position) <= kLargestJointPosition;
    }
    return in_filter_range;
  }
  return std::all_of(robot_.joints().begin(), robot_.joints().end(), [&](const Joint& joint) {
    if (!joint.moves()) return true;
    const double variable = configuration[static_cast<std::size_t>(joint.variable)];
    return std::abs(joint.multiplier * variable + joint.offset) <= kLargestJointPosition;
  });
}

void BodyPairs::place(std::span<const double> configuration, Scratch& scratch) const {
  forward_kinematics(robot_, configuration, scratch.world_from_link, world_from_root_);
  scratch.configuration.assign(configuration.begin(), configuration.end());
  scratch.placed.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Sphere sphere = pieces_[i].tree->sphere(0);
    scratch.placed[i] = {pose_of(pieces_[i], scratch) * sphere.center, sphere.radius};
  }
  scratch.pad =
      in_filter_range(configuration) ? kSpherePad * size_ : std::numeric_limits<double>::infinity();
}

// From the centre of a piece's root sphere to a primitive; -infinity for other obstacles.
double BodyPairs::signed_distance(const CheckedPair& pair, const Scratch& scratch) const {
  const PlacedShape& obstacle = obstacles_[static_cast<std::size_t>(pair.other)];
  const Primitive* const solid = std::get_if<Primitive>(&obstacle.shape);
  if (solid == nullptr) return -std::numeric_limits<double>::infinity();
  const Eigen::Vector3d center = obstacle.world_from_shape.matrix().transpose() *
                                 (scratch.placed[static_cast<std::size_t>(pair.piece)].center -
                                  obstacle.world_from_shape.translation());
  return std::visit([&](const auto& shape) { return field_of(shape).signed_distance(center); },
                    *solid);
}

// True only if the canonical test for this clearance would say no.
bool BodyPairs::spheres_apart(const CheckedPair& pair, double clearance,
                              const Scratch& scratch) const {
  const Sphere& a = scratch.placed[static_cast<std::size_t>(pair.piece)];
  if (pair.is_obstacle) {
    const double reach = a.radius + (clearance * (1.0 + 1e-9) + 2.0 * scratch.pad);
    if (is_beyond(static_cast<std::size_t>(pair.other), a.center, reach)) return true;
    return signed_distance(pair, scratch) > reach;
  }
  const Sphere& b = scratch.placed[static_cast<std::size_t>(pair.other)];
  const double limit = (a.radius + b.radius) + (clearance * (1.0 + 1e-9) + scratch.pad);
  return (a.center - b.center).squaredNorm() > limit * limit;
}

bool BodyPairs::touches(std::size_t index, const Scratch& scratch) const {
  const CheckedPair& pair = pairs_[index];
  if (spheres_apart(pair, 0.0, scratch) || is_proved_free(index, scratch)) return false;
  const CheckedPiece& a = pieces_[static_cast<std::size_t>(pair.piece)];
  bool touch = false;
  if (pair.is_obstacle) {
    const PlacedShape& obstacle = obstacles_[static_cast<std::size_t>(pair.other)];
    touch = with_shape(obstacle, [&](const auto& shape) {
      return collides(*a.tree, pose_of(a, scratch), shape, obstacle.world_from_shape);
    });
  } else {
    const CheckedPiece& b = pieces_[static_cast<std::size_t>(pair.other)];
    touch = collides(*a.tree, pose_of(a, scratch), *b.tree, pose_of(b, scratch));
  }
  return touch && (!is_confirmed(pair) || meshes_within(pair, 0.0, scratch));
}

// A robot that touches often did so a moment ago, in the same place.
bool BodyPairs::any_touches(Scratch& scratch) const {
  if (scratch.last < static_tree_pairs_begin_ && touches(scratch.last, scratch)) return true;
  for (std::size_t i = 0; i < static_tree_pairs_begin_; ++i) {
    if (i == scratch.last || !touches(i, scratch)) continue;
    scratch.last = i;
    return true;
  }
  return false;
}

bool BodyPairs::is_near(std::size_t index, double clearance, const Scratch& scratch) const {
  const CheckedPair& pair = pairs_[index];
  if (!(clearance <= kMaxCoordinate)) return true;
  return !spheres_apart(pair, clearance, scratch) && spheres_within(pair, clearance, scratch) &&
         (!is_confirmed(pair) || meshes_within(pair, clearance, scratch));
}

bool BodyPairs::spheres_within(const CheckedPair& pair, double clearance,
                               const Scratch& scratch) const {
  const CheckedPiece& a = pieces_[static_cast<std::size_t>(pair.piece)];
  if (!pair.is_obstacle) {
    const CheckedPiece& b = pieces_[static_cast<std::size_t>(pair.other)];
    return within(*a.tree, pose_of(a, scratch), *b.tree, pose_of(b, scratch), clearance);
  }
  const PlacedShape& obstacle = obstacles_[static_cast<std::size_t>(pair.other)];
  return with_shape(obstacle, [&](const auto& shape) {
    return within(*a.tree, pose_of(a, scratch), shape, obstacle.world_from_shape, clearance);
  });
}

bool BodyPairs::is_confirmed(const CheckedPair& pair) const {
  const auto other = static_cast<std::size_t>(pair.other);
  return pieces_[static_cast<std::size_t>(pair.piece)].mesh != nullptr ||
         (pair.is_obstacle ? obstacles_[other].mesh : pieces_[other].mesh) != nullptr;
}

// The padding of a side whose mesh is known is not in what is tested; that of spheres is.
bool BodyPairs::meshes_within(const CheckedPair& pair, double clearance,
                              const Scratch& scratch) const {
  const CheckedPiece& a = pieces_[static_cast<std::size_t>(pair.piece)];
  const auto other = static_cast<std::size_t>(pair.other);
  const CheckedPiece* const b = pair.is_obstacle ? nullptr : &pieces_[other];
  const CoveredMesh* const mesh_b = b != nullptr ? b->mesh.get() : obstacles_[other].mesh.get();
  const Pose& pose_a = pose_of(a, scratch);
  const Pose& pose_b = b != nullptr ? pose_of(*b, scratch) : obstacles_[other].world_from_shape;
  double reach = clearance;
  if (a.mesh != nullptr) reach = sum_up(reach, a.padding);
  if (b != nullptr && mesh_b != nullptr) reach = sum_up(reach, b->padding);
  if (!(reach <= kMaxCoordinate)) return true;  // the queries refuse it
  if (a.mesh == nullptr) return within(*a.tree, pose_a, mesh_b->solid(), pose_b, reach);
  if (mesh_b != nullptr) {
    return reach == 0.0 ? collides(*a.mesh, pose_a, *mesh_b, pose_b)
                        : within(a.mesh->solid(), pose_a, mesh_b->solid(), pose_b, reach);
  }
  if (b != nullptr) return within(*b->tree, pose_b, a.mesh->solid(), pose_a, reach);
  return with_shape(obstacles_[other], [&](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, SphereTree>) {
      return within(shape, pose_b, a.mesh->solid(), pose_a, reach);
    } else {
      return within(a.mesh->solid(), pose_a, shape, pose_b, reach);
    }
  });
}

double BodyPairs::gap_bound(std::size_t index, const Scratch& scratch) const {
  const CheckedPair& pair = pairs_[index];
  const Sphere& a = scratch.placed[static_cast<std::size_t>(pair.piece)];
  if (pair.is_obstacle) return signed_distance(pair, scratch) - a.radius - 2.0 * scratch.pad;
  const Sphere& b = scratch.placed[static_cast<std::size_t>(pair.other)];
  return distance_lower(a.center, b.center) - (a.radius + b.radius) - scratch.pad;
}

DistanceResult BodyPairs::distance(std::size_t index, const Scratch& scratch,
                                   const DistanceRequest& request) const {
  const CheckedPair& pair = pairs_[index];
  const CheckedPiece& a = pieces_[static_cast<std::size_t>(pair.piece)];
  if (!pair.is_obstacle) {
    const CheckedPiece& b = pieces_[static_cast<std::size_t>(pair.other)];
    return spherule::distance(*a.tree, pose_of(a, scratch), *b.tree, pose_of(b, scratch), request);
  }
  const PlacedShape& obstacle = obstacles_[static_cast<std::size_t>(pair.other)];
  return with_shape(obstacle, [&](const auto& shape) {
    return spherule::distance(*a.tree, pose_of(a, scratch), shape, obstacle.world_from_shape,
                              request);
  });
}

std::optional<PairContact> BodyPairs::deepest_contact(std::size_t index,
                                                      const Scratch& scratch) const {
  const auto between_trees =
      [&](const std::optional<Contact>& found) -> std::optional<PairContact> {
    if (!found) return std::nullopt;
    return PairContact{found->leaves.a, found->leaves.b, found->penetration_depth, found->position};
  };
  const CheckedPair& pair = pairs_[index];
  const CheckedPiece& a = pieces_[static_cast<std::size_t>(pair.piece)];
  if (is_confirmed(pair)) {
    if (!touches(index, scratch)) return std::nullopt;
    const auto other = static_cast<std::size_t>(pair.other);
    const bool is_padded = a.padding > 0.0 || (!pair.is_obstacle && pieces_[other].padding > 0.0);
    const auto& mesh_b = pair.is_obstacle ? obstacles_[other].mesh : pieces_[other].mesh;
    if (a.mesh != nullptr && mesh_b != nullptr && !is_padded) {
      return between_trees(spherule::deepest_contact(*a.mesh, pose_of(a, scratch), *mesh_b,
                                                     pair.is_obstacle
                                                         ? obstacles_[other].world_from_shape
                                                         : pose_of(pieces_[other], scratch)));
    }
  }
  if (!pair.is_obstacle) {
    const CheckedPiece& b = pieces_[static_cast<std::size_t>(pair.other)];
    return between_trees(
        spherule::deepest_contact(*a.tree, pose_of(a, scratch), *b.tree, pose_of(b, scratch)));
  }
  const PlacedShape& obstacle = obstacles_[static_cast<std::size_t>(pair.other)];
  return with_shape(obstacle, [&](const auto& shape) -> std::optional<PairContact> {
    const auto found =
        spherule::deepest_contact(*a.tree, pose_of(a, scratch), shape, obstacle.world_from_shape);
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, SphereTree>) {
      return between_trees(found);
    } else {
      if (!found) return std::nullopt;
      return PairContact{found->leaves.a, -1, found->penetration_depth, found->position};
    }
  });
}

void take_between(std::span<const double> from, std::span<const double> to, double at,
                  std::vector<double>& configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    configuration[i] = (1.0 - at) * from[i] + at * to[i];
  }
}

EdgeProofs::EdgeProofs(const BodyPairs& pairs)
    : pairs_(pairs),
      begin_(static_cast<std::size_t>(pairs.robot().variable_count())),
      end_(begin_.size()),
      is_free_(pairs.pairs().size()) {}

void EdgeProofs::take(std::span<const double> from, std::span<const double> to) {
  from_ = from;
  to_ = to;
  std::fill(is_free_.begin(), is_free_.end(), std::int8_t{-1});
}

bool EdgeProofs::is_free_at(std::size_t pair, double at) {
  take_between(from_, to_, at, begin_);
  return boxes_of(pair).contains(begin_);
}

bool EdgeProofs::is_free(std::size_t pair) {
  std::int8_t& is_free = is_free_[pair];
  if (is_free < 0) is_free = boxes_of(pair).contains_edge(from_, to_) ? 1 : 0;
  return is_free == 1;
}

}  // namespace spherule::internal
