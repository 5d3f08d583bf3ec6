// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/fcl_solid.h"

#include "tests/support/fcl_models.h"
#include "tests/support/mesh_facts.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>

namespace spherule {

struct FclSolid::Model : FclModel<fcl::OBBRSSd> {
  using FclModel::FclModel;
};

FclSolid::FclSolid(const TriangleMesh& mesh)
    : components_(is_closed(mesh) ? components(mesh) : std::vector<TriangleMesh>()),
      points_(component_points(mesh)),
      model_(std::make_unique<Model>(mesh)) {}

FclSolid::FclSolid(FclSolid&&) noexcept = default;
FclSolid& FclSolid::operator=(FclSolid&&) noexcept = default;
FclSolid::~FclSolid() = default;

const Eigen::AlignedBox3d& FclSolid::box() const {
  return model_->box;
}

bool FclSolid::contains(const Eigen::Vector3d& point) const {
  return box().contains(point) &&
         std::any_of(components_.begin(), components_.end(), [&](const TriangleMesh& component) {
           return std::abs(winding_number(component, point)) > 0.5;
         });
}

bool FclSolid::contains_a_component_of(const FclSolid& other, const Pose& this_from_other) const {
  return std::any_of(other.points_.begin(), other.points_.end(), [&](const Eigen::Vector3d& point) {
    return contains(this_from_other * point);
  });
}

bool touch(const FclSolid& a, const Pose& world_from_a, const FclSolid& b,
           const Pose& world_from_b) {
  const auto pose_a = fcl_pose<double>(world_from_a);
  const auto pose_b = fcl_pose<double>(world_from_b);
  if (!a.model_->world_box(pose_a).intersects(b.model_->world_box(pose_b))) return false;
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1;
  request.enable_contact = false;
  fcl::CollisionResultd result;
  fcl::collide(a.model_->geometry.get(), pose_a, b.model_->geometry.get(), pose_b, request, result);
  if (result.isCollision()) return true;
  const Pose a_from_b = world_from_a.inverse() * world_from_b;
  return a.contains_a_component_of(b, a_from_b) || b.contains_a_component_of(a, a_from_b.inverse());
}

double surface_distance(const FclSolid& a, const Pose& world_from_a, const FclSolid& b,
                        const Pose& world_from_b) {
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(a.model_->geometry.get(), fcl_pose<double>(world_from_a),
                       b.model_->geometry.get(), fcl_pose<double>(world_from_b), request, result);
}

}  // namespace spherule
