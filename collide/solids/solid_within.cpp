// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/solid_within.h"

#include "collide/meshes/mesh_inside.h"
#include "collide/search/box_gap.h"
#include "collide/search/queries.h"
#include "collide/search/query.h"
#include "collide/search/traversal.h"
#include "collide/solids/solid_pose.h"
#include "collide/solids/triangle_field.h"
#include "geometry/point_triangle.h"
#include "geometry/triangles.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::Triangle;

// An image errs by less than 136 u S (search/relative_pose.h).
constexpr double kImageError = 136.0 * kUnitRoundoff;

// Leaf test of two triangles: not proved to be farther apart than the clearance. An axis that
// triangle_contact() finds to separate them by more than its pad separates the exact triangles by
// what the pad has above the 76 u S that are required of it: the clearance, and 32 u of it, of
// which the comparison takes 4 u. No two triangles come nearer than the spheres around them, so
// those must touch canonically as well.
class TrianglePairLeaves {
 public:
  TrianglePairLeaves(const SolidMesh& a, const Pose& world_from_a, const SolidMesh& b,
                     const Pose& world_from_b, const internal::RelativePose& pose, double clearance)
      : a_(a.mesh()),
        b_(b.mesh()),
        boxes_a_(a.mesh().node_boxes()),
        boxes_b_(b.mesh().node_boxes()),
        pose_(pose),
        b_from_a_(pose.b_from_a()),
        rotation_a_(world_from_a.matrix()),
        rotation_b_(world_from_b.matrix()),
        shift_(0.5 * (world_from_a.translation() - world_from_b.translation())),
        clearance_(clearance),
        pad_(pose.leaf_pad() + clearance * (1.0 + 32.0 * kUnitRoundoff)),
        box_limit_(pose.slack() + clearance * internal::kMarginUp +
                   internal::kBoxError * pose.scene_size() + 0x1p-160) {}

  // True for all nodes below which triangles come within the clearance and the slack.
  bool may_touch(internal::NodePair pair) const {
    return internal::box_gap(boxes_a_.box(pair.index(0)), boxes_b_.box(pair.index(1)), b_from_a_) <=
           box_limit_;
  }

  bool touches(internal::NodePair pair) const {
    const std::int32_t i = a_.tree().sphere_index(pair.index(0));
    const std::int32_t j = b_.tree().sphere_index(pair.index(1));
    if (!pose_.touches(a_.tree().spheres()[static_cast<std::size_t>(i)],
                       b_.tree().spheres()[static_cast<std::size_t>(j)], clearance_)) {
      return false;
    }
    const Triangle of_a = placed(a_.triangle(i), rotation_a_, shift_);
    const Triangle of_b = placed(b_.triangle(j), rotation_b_, -shift_);
    if (are_apart(axis_, of_a, of_b)) return false;
    if (are_apart(middle_of(of_a) - middle_of(of_b), of_a, of_b)) return false;
    for (const auto& [one, other] : {std::pair(&of_a, &of_b), std::pair(&of_b, &of_a)}) {
      const Vector3d nearest = nearest_way(*one, *other);
      if (nearest.squaredNorm() <= clearance_ * clearance_) return true;
      if (are_apart(nearest, of_a, of_b)) return false;
    }
    return internal::triangle_contact(of_a, of_b, pad_, pose_.scene_size()) !=
           internal::TriangleContact::kApart;
  }

 private:
  static Triangle placed(const Triangle& corners, const Eigen::Matrix3d& rotation,
                         const Vector3d& shift) {
    return {rotation * corners[0] + shift, rotation * corners[1] + shift,
            rotation * corners[2] + shift};
  }

  static Vector3d middle_of(const Triangle& t) { return t[0] + t[1] + t[2]; }

  // From the nearest point of a triangle to the corner of another one that is nearest to it.
  static Vector3d nearest_way(const Triangle& corners, const Triangle& t) {
    Vector3d nearest = Vector3d::Constant(std::numeric_limits<double>::max());
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3d& corner : corners) {
      const Vector3d way = corner - point_triangle_distance(corner, t[0], t[1], t[2]).closest;
      if (way.squaredNorm() >= least) continue;
      least = way.squaredNorm();
      nearest = way;
    }
    return nearest;
  }

  bool are_apart(const Vector3d& axis, const Triangle& of_a, const Triangle& of_b) const {
    if (!internal::separates(axis, internal::gap_along(axis, of_a, of_b), pad_)) return false;
    axis_ = axis;
    return true;
  }

  const MeshTree& a_;
  const MeshTree& b_;
  const internal::NodeBoxes& boxes_a_;
  const internal::NodeBoxes& boxes_b_;
  const internal::RelativePose& pose_;
  const internal::FrameChange b_from_a_;
  const Eigen::Matrix3d rotation_a_;
  const Eigen::Matrix3d rotation_b_;
  const Vector3d shift_;
  const double clearance_;
  const double pad_;
  const double box_limit_;
  mutable Vector3d axis_ = Vector3d::UnitX();  // that separated two triangles last
};

// Whether a plane keeps two meshes farther apart than the reach: found by Gilbert's iteration for
// the nearest points of their convex hulls, of which no step has to be exact. Few steps: where they
// do not do, the triangles are near each other, or one hull reaches into the other.
//
// For any axis n the least n.x - n.y over all corners x and y, as computed here, errs by 68 u |n| S
// for the corners (triangles.h), 3 u |n| S for each of the two images of n, 3 u |n| S for each
// product and 6 u |n| S for the shift and the sums: less than kPad u |n| S.
class HullSearch {
 public:
  HullSearch(const MeshTree& a, const Pose& world_from_a, const MeshTree& b,
             const Pose& world_from_b, const internal::RelativePose& pose, double reach)
      : a_(a),
        b_(b),
        rotation_a_(world_from_a.matrix()),
        rotation_b_(world_from_b.matrix()),
        shift_(world_from_a.translation() - world_from_b.translation()),
        limit_(reach * (1.0 + 32.0 * kUnitRoundoff) + kPad * kUnitRoundoff * pose.scene_size() +
               kUnderflow) {}

  // Every step examines all corners.
  static bool is_worth_while(const MeshTree& a, const MeshTree& b) {
    return a.tree().spheres().size() + b.tree().spheres().size() <= kMostTriangles;
  }

  bool finds_a_plane() const {
    Vector3d nearest = rotation_a_ * a_.tree().sphere(0).center + shift_ -
                       rotation_b_ * b_.tree().sphere(0).center;
    for (int step = 0; step < kSteps; ++step) {
      // The corner of the difference that is farthest against the axis.
      const Vector3d corner = rotation_a_ * least_along(a_, rotation_a_.transpose() * nearest) +
                              shift_ -
                              rotation_b_ * least_along(b_, rotation_b_.transpose() * -nearest);
      const double gap = nearest.dot(corner);
      if (internal::separates(nearest, gap, limit_)) return true;
      const Vector3d way = corner - nearest;
      const double length = way.squaredNorm();
      if (!(length > 0.0)) return false;
      nearest += std::clamp(-nearest.dot(way) / length, 0.0, 1.0) * way;
    }
    return false;
  }

 private:
  static constexpr std::size_t kMostTriangles = 4000;
  static constexpr int kSteps = 12;
  static constexpr double kPad = 128.0;

  static Vector3d least_along(const MeshTree& mesh, const Vector3d& axis) {
    Vector3d least = Vector3d::Zero();
    double value = std::numeric_limits<double>::infinity();
    const auto count = static_cast<std::int32_t>(mesh.tree().spheres().size());
    for (std::int32_t i = 0; i < count; ++i) {
      for (const Vector3d& corner : mesh.triangle(i)) {
        const double along = axis.dot(corner);
        if (along >= value) continue;
        value = along;
        least = corner;
      }
    }
    return least;
  }

  const MeshTree& a_;
  const MeshTree& b_;
  const Eigen::Matrix3d rotation_a_;
  const Eigen::Matrix3d rotation_b_;
  const Vector3d shift_;
  const double limit_;
};

// A component of `other` lies in the inside of `solid`, if no triangles touch.
bool holds_a_component(const SolidMesh& solid, const SolidMesh& other,
                       const internal::FrameChange& solid_from_other, double error) {
  const std::span<const Vector3d> points = other.mesh().component_points();
  return solid.has_inside() && std::any_of(points.begin(), points.end(), [&](const Vector3d& p) {
           return solid.inside().contains(solid.mesh(), solid_from_other(p), error);
         });
}

// Ends at the first triangle that is not proved to be farther from the solid than the reach.
template <class Field>
class FindTriangle {
 public:
  FindTriangle(const MeshTree& mesh, const internal::SolidPose<Field>& pose,
               const internal::TriangleField<Field>& field)
      : mesh_(mesh), pose_(pose), field_(field) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    return pose_.may_touch(mesh_.tree().sphere(static_cast<std::size_t>(node)));
  }
  bool leaf(std::int32_t node) {
    const auto& [p, q, r] =
        mesh_.triangle(mesh_.tree().sphere_index(static_cast<std::size_t>(node)));
    found_ = field_.comes_near({pose_.in_solid(p), pose_.in_solid(q), pose_.in_solid(r)});
    return !found_;
  }
  bool found() const { return found_; }

 private:
  const MeshTree& mesh_;
  const internal::SolidPose<Field>& pose_;
  const internal::TriangleField<Field>& field_;
  bool found_ = false;
};

template <class Field>
bool comes_within(const SolidMesh& mesh, const Pose& world_from_mesh, const Field& field,
                  const Pose& world_from_field, double reach) {
  const internal::SolidPose<Field> pose(mesh.mesh().tree(), world_from_mesh, field,
                                        world_from_field, reach);
  const internal::RelativePose relative(mesh.mesh().tree(), world_from_mesh, field.reach(),
                                        world_from_field);
  const double error = kImageError * relative.scene_size() + kUnderflow;
  const internal::TriangleField<Field> near(field, reach, error);
  FindTriangle<Field> query(mesh.mesh(), pose, near);
  internal::search_tree(mesh.mesh().tree(), query);
  if (query.found()) return true;
  // The solid is connected: it is inside as a whole, or outside.
  return mesh.has_inside() &&
         mesh.inside().contains(mesh.mesh(), relative.a_from_b()(Vector3d::Zero()), error);
}

}  // namespace

bool within(const SolidMesh& a, const Pose& world_from_a, const SolidMesh& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  const double reach = sum_up(clearance, sum_up(a.inflation(), b.inflation()));
  const SphereTree& tree_a = a.mesh().tree();
  const SphereTree& tree_b = b.mesh().tree();
  if (internal::far_apart(tree_a, world_from_a, tree_b, world_from_b, reach)) return false;
  const internal::RelativePose pose(tree_a, world_from_a, tree_b, world_from_b);
  if (internal::boxes_apart(tree_a, tree_b, pose, reach)) return false;
  if (HullSearch::is_worth_while(a.mesh(), b.mesh()) &&
      HullSearch(a.mesh(), world_from_a, b.mesh(), world_from_b, pose, reach).finds_a_plane()) {
    return false;
  }
  const TrianglePairLeaves leaves(a, world_from_a, b, world_from_b, pose, reach);
  if (internal::any_pair_within(tree_a, tree_b, pose, leaves, reach)) return true;
  const double error = kImageError * pose.scene_size() + kUnderflow;
  return holds_a_component(a, b, pose.a_from_b(), error) ||
         holds_a_component(b, a, pose.b_from_a(), error);
}

bool within(const SolidMesh& a, const Pose& world_from_a, const Primitive& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return std::visit(
      [&](const auto& shape) {
        return comes_within(a, world_from_a, internal::field_of(shape), world_from_b,
                            sum_up(clearance, a.inflation()));
      },
      b);
}

}  // namespace spherule
