// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/fcl_arm.h"

#include "bench/fcl_models.h"
#include "bench/fcl_solid.h"
#include "collide/robot/kinematics.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct MakeGeometry {
  Geometry operator()(const Box& box) const { return std::make_shared<fcl::Boxd>(box.size); }
  Geometry operator()(const Ball& ball) const {
    return std::make_shared<fcl::Sphered>(ball.radius);
  }
  Geometry operator()(const Cylinder& solid) const {
    return std::make_shared<fcl::Cylinderd>(solid.radius, solid.length);
  }
  Geometry operator()(const Capsule& solid) const {
    return std::make_shared<fcl::Capsuled>(solid.radius, solid.length);
  }
  Geometry operator()(const HalfSpace&) const {
    throw std::logic_error("the scenes have no half-spaces");
  }
};

struct FclObstacle {
  Geometry geometry;
  fcl::Transform3d pose;
  Eigen::AlignedBox3d box;
};

}  // namespace

struct FclArm::Parts {
  const RobotModel& robot;
  TestedLinks tested;
  std::vector<std::unique_ptr<FclModel<fcl::OBBRSSd>>> links{};
  std::vector<Geometry> geometries{};             // of these, with the volumes that are asked for
  std::vector<std::optional<FclSolid>> solids{};  // of links with meshes, with their insides
  std::vector<FclObstacle> obstacles{};
  fcl::CollisionRequestd request{};
  std::vector<Pose> world_from_link{};
  std::vector<fcl::Transform3d> poses{};
  std::vector<Eigen::AlignedBox3d> boxes{};

  bool touch(const fcl::CollisionGeometryd* a, const fcl::Transform3d& pose_a,
             const fcl::CollisionGeometryd* b, const fcl::Transform3d& pose_b) const {
    fcl::CollisionResultd result;
    return fcl::collide(a, pose_a, b, pose_b, request, result) > 0;
  }
};

FclArm::FclArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene,
               FclVolume volume)
    : volume_(volume),
      parts_(std::make_unique<Parts>(Parts{arm.model, tested_links(arm, allowed)})) {
  for (const TriangleMesh& mesh : arm.meshes) {
    parts_->links.push_back(
        mesh.triangles.empty() ? nullptr : std::make_unique<FclModel<fcl::OBBRSSd>>(mesh));
    Geometry geometry;
    if (!mesh.triangles.empty() && volume == FclVolume::kObb) {
      geometry = FclModel<fcl::OBBd>(mesh).geometry;
    } else if (!mesh.triangles.empty()) {
      geometry = parts_->links.back()->geometry;
    }
    parts_->geometries.push_back(std::move(geometry));
    auto& solid = parts_->solids.emplace_back();
    if (!mesh.triangles.empty()) solid.emplace(mesh);
  }
  const auto add = [&](const Geometry& geometry, const Pose& world_from_geometry) {
    const fcl::Transform3d pose = fcl_pose<double>(world_from_geometry);
    fcl::CollisionObjectd object(geometry, pose);
    object.computeAABB();
    parts_->obstacles.push_back(
        {geometry, pose, Eigen::AlignedBox3d(object.getAABB().min_, object.getAABB().max_)});
  };
  for (const PlacedPrimitive& obstacle : scene.obstacles) {
    add(std::visit(MakeGeometry(), obstacle.primitive), obstacle.world_from_primitive);
  }
  for (const Eigen::Vector3d& point : scene.cloud) {
    add(std::make_shared<fcl::Sphered>(scene.cloud_radius), Pose::from_translation(point));
  }
  if (!scene.mesh.triangles.empty()) {
    add(volume == FclVolume::kObb ? Geometry(FclModel<fcl::OBBd>(scene.mesh).geometry)
                                  : Geometry(FclModel<fcl::OBBRSSd>(scene.mesh).geometry),
        Pose());
  }
  parts_->poses.resize(parts_->links.size());
  parts_->boxes.resize(parts_->links.size());
}

FclArm::~FclArm() = default;

const char* FclArm::name() const {
  return volume_ == FclVolume::kObb ? "FCL OBB" : "FCL OBBRSS";
}

bool FclArm::collides(std::span<const double> configuration) {
  Parts& in = *parts_;
  forward_kinematics(in.robot, configuration, in.world_from_link);
  for (std::size_t i = 0; i < in.links.size(); ++i) {
    if (!in.links[i]) continue;
    in.poses[i] = fcl_pose<double>(in.world_from_link[i]);
    in.boxes[i] = in.links[i]->world_box(in.poses[i]);
  }
  for (const std::size_t link : in.tested.moving) {
    for (const FclObstacle& obstacle : in.obstacles) {
      if (!in.boxes[link].intersects(obstacle.box)) continue;
      if (in.touch(in.geometries[link].get(), in.poses[link], obstacle.geometry.get(),
                   obstacle.pose)) {
        return true;
      }
    }
  }
  for (const auto& [a, b] : in.tested.pairs) {
    if (!in.boxes[a].intersects(in.boxes[b])) continue;
    if (in.touch(in.geometries[a].get(), in.poses[a], in.geometries[b].get(), in.poses[b])) {
      return true;
    }
  }
  return false;
}

bool FclArm::holds_an_obstacle(std::span<const double> configuration) {
  Parts& in = *parts_;
  forward_kinematics(in.robot, configuration, in.world_from_link);
  return std::any_of(in.tested.moving.begin(), in.tested.moving.end(), [&](std::size_t link) {
    const Pose link_from_world = in.world_from_link[link].inverse();
    return std::any_of(in.obstacles.begin(), in.obstacles.end(), [&](const FclObstacle& obstacle) {
      return in.solids[link]->contains(link_from_world * obstacle.pose.translation());
    });
  });
}

}  // namespace spherule
