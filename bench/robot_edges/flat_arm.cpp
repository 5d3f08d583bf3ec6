// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/flat_arm.h"

#include "collide/solids/solid_fields.h"
#include "robot/model/kinematics.h"

#include <variant>

namespace spherule {

void FlatArm::Spheres::add(const Sphere& sphere) {
  x.push_back(sphere.center.x());
  y.push_back(sphere.center.y());
  z.push_back(sphere.center.z());
  radius.push_back(sphere.radius);
}

FlatArm::FlatArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene)
    : robot_(arm.model), scene_(scene) {
  for (std::size_t link = 0; link < robot_.links().size(); ++link) {
    for (const auto& tree : robot_.links()[link].trees) {
      const bool moves =
          link != 0 && allowed.reason(0, static_cast<int>(link)) != AllowedReason::kRigid;
      LinkSpheres& spheres = links_.emplace_back(LinkSpheres{link, moves, {}, tree->sphere(0)});
      for (const Sphere& sphere : tree->spheres()) spheres.spheres.add(sphere);
    }
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    for (std::size_t k = i + 1; k < links_.size(); ++k) {
      if (!allowed.allows(static_cast<int>(links_[i].link), static_cast<int>(links_[k].link))) {
        pairs_.emplace_back(i, k);
      }
    }
  }
  for (const Eigen::Vector3d& point : scene.cloud) cloud_.add({point, scene.cloud_radius});
  for (const LinkSpheres& link : links_) placed_.push_back(link.spheres);
  around_.resize(links_.size());
}

bool FlatArm::any_within(const Spheres& spheres, const Eigen::Vector3d& center, double radius) {
  int found = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double x = spheres.x[i] - center.x(), y = spheres.y[i] - center.y(),
                 z = spheres.z[i] - center.z(), reach = spheres.radius[i] + radius;
    found |= x * x + y * y + z * z <= reach * reach ? 1 : 0;
  }
  return found != 0;
}

bool FlatArm::touches_obstacles(const Spheres& placed, const Sphere& around) const {
  for (const PlacedPrimitive& obstacle : scene_.obstacles) {
    const bool intersects = std::visit(
        [&](const auto& shape) {
          const auto field = internal::field_of(shape);
          const Eigen::Matrix3d rotation = obstacle.world_from_primitive.matrix().transpose();
          const Eigen::Vector3d& origin = obstacle.world_from_primitive.translation();
          const Eigen::Vector3d root = rotation * (around.center - origin);
          if (field.signed_distance(root) > around.radius) return false;
          bool found = false;
          for (std::size_t i = 0; i < placed.size(); ++i) {
            const Eigen::Vector3d p =
                rotation * (Eigen::Vector3d(placed.x[i], placed.y[i], placed.z[i]) - origin);
            found = found || field.signed_distance(p) <= placed.radius[i];
          }
          return found;
        },
        obstacle.primitive);
    if (intersects) return true;
  }
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const Eigen::Vector3d point(cloud_.x[i], cloud_.y[i], cloud_.z[i]);
    const double reach = around.radius + cloud_.radius[i];
    if ((around.center - point).squaredNorm() > reach * reach) continue;
    if (any_within(placed, point, cloud_.radius[i])) return true;
  }
  return false;
}

bool FlatArm::collides(std::span<const double> configuration) {
  forward_kinematics(robot_, configuration, poses_);
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Pose& pose = poses_[links_[k].link];
    const Eigen::Matrix3d& r = pose.matrix();
    const Eigen::Vector3d& t = pose.translation();
    const Spheres& from = links_[k].spheres;
    Spheres& to = placed_[k];
    for (std::size_t i = 0; i < from.size(); ++i) {
      to.x[i] = r(0, 0) * from.x[i] + r(0, 1) * from.y[i] + r(0, 2) * from.z[i] + t.x();
      to.y[i] = r(1, 0) * from.x[i] + r(1, 1) * from.y[i] + r(1, 2) * from.z[i] + t.y();
      to.z[i] = r(2, 0) * from.x[i] + r(2, 1) * from.y[i] + r(2, 2) * from.z[i] + t.z();
    }
    around_[k] = {r * links_[k].around.center + t, links_[k].around.radius};
  }
  for (std::size_t k = links_.size(); k-- > 0;) {
    if (links_[k].moves && touches_obstacles(placed_[k], around_[k])) return true;
  }
  for (const auto& [a, b] : pairs_) {
    const double reach = around_[a].radius + around_[b].radius;
    if ((around_[a].center - around_[b].center).squaredNorm() > reach * reach) continue;
    const Spheres& of_a = placed_[a];
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      if (any_within(placed_[b], {of_a.x[i], of_a.y[i], of_a.z[i]}, of_a.radius[i])) return true;
    }
  }
  return false;
}

}  // namespace spherule
