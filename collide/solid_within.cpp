// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solid_within.h"

#include "collide/internal/mesh_inside.h"
#include "collide/internal/one_tree.h"
#include "collide/internal/queries.h"
#include "collide/internal/solid_pose.h"
#include "collide/internal/triangle_field.h"
#include "collide/internal/triangle_pair.h"
#include "collide/within.h"

#include <algorithm>
#include <span>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::Triangle;

// An image errs by less than 136 u S (internal/relative_pose.h).
constexpr double kImageError = 136.0 * kUnitRoundoff;

double sum_up(double a, double b) {
  return a == 0.0 || b == 0.0 ? a + b : add_up(a, b);
}

// Leaf test of two triangles: not proved to be farther apart than the clearance. An axis that
// triangle_contact() finds to separate them by more than its pad separates the exact triangles by
// what the pad has above the 76 u S that it is asked for: the clearance, and 32 u of it, of which
// the comparison takes 4 u. No two triangles come nearer than the balls around them, so those must
// touch canonically as well.
class TrianglePairLeaves {
 public:
  TrianglePairLeaves(const MeshTree& a, const Pose& world_from_a, const MeshTree& b,
                     const Pose& world_from_b, const RelativePose& pose, double clearance)
      : a_(a),
        b_(b),
        pose_(pose),
        rotation_a_(world_from_a.matrix()),
        rotation_b_(world_from_b.matrix()),
        shift_(0.5 * (world_from_a.translation() - world_from_b.translation())),
        clearance_(clearance),
        pad_(pose.leaf_pad() + clearance * (1.0 + 32.0 * kUnitRoundoff)) {}

  bool touches(NodePair pair) const {
    const std::int32_t i = a_.tree().sphere_index(pair.index(0));
    const std::int32_t j = b_.tree().sphere_index(pair.index(1));
    return pose_.touches(a_.tree().spheres()[static_cast<std::size_t>(i)],
                         b_.tree().spheres()[static_cast<std::size_t>(j)], clearance_) &&
           internal::triangle_contact(placed(a_.triangle(i), rotation_a_, shift_),
                                      placed(b_.triangle(j), rotation_b_, -shift_), pad_,
                                      pose_.scene_size()) != internal::TriangleContact::kApart;
  }

 private:
  static Triangle placed(const Triangle& corners, const Eigen::Matrix3d& rotation,
                         const Vector3d& shift) {
    return {rotation * corners[0] + shift, rotation * corners[1] + shift,
            rotation * corners[2] + shift};
  }

  const MeshTree& a_;
  const MeshTree& b_;
  const RelativePose& pose_;
  const Eigen::Matrix3d rotation_a_;
  const Eigen::Matrix3d rotation_b_;
  const Vector3d shift_;
  const double clearance_;
  const double pad_;
};

// A component of `other` lies in the inside of `solid`, if no triangles touch.
bool holds_a_component(const SolidMesh& solid, const SolidMesh& other,
                       const FrameChange& solid_from_other, double error) {
  const std::span<const Vector3d> points = other.inside().component_points();
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
    return pose_.may_touch(mesh_.tree().ball(static_cast<std::size_t>(node)));
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
  const RelativePose relative(mesh.mesh().tree(), world_from_mesh, field.reach(), world_from_field);
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
  const double reach = sum_up(clearance, sum_up(a.growth(), b.growth()));
  const SphereTree& tree_a = a.mesh().tree();
  const SphereTree& tree_b = b.mesh().tree();
  if (internal::far_apart(tree_a, world_from_a, tree_b, world_from_b, reach)) return false;
  const RelativePose pose(tree_a, world_from_a, tree_b, world_from_b);
  if (internal::boxes_apart(tree_a, tree_b, pose, reach)) return false;
  const TrianglePairLeaves leaves(a.mesh(), world_from_a, b.mesh(), world_from_b, pose, reach);
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
                            sum_up(clearance, a.growth()));
      },
      b);
}

}  // namespace spherule
