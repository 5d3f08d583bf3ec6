// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/peer_arms.h"

#include "robot/model/kinematics.h"
#include "tests/support/fcl_models.h"
#include "tests/support/fcl_solid.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
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
  Geometry operator()(const SolidSphere& sphere) const {
    return std::make_shared<fcl::Sphered>(sphere.radius);
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

// Obstacles beyond this number are in a tree of their boxes.
constexpr std::size_t kFewObstacles = 64;

struct FclObstacle {
  Geometry geometry;
  fcl::Transform3d pose;
  Eigen::AlignedBox3d box;
  std::unique_ptr<fcl::CollisionObjectd> object;
};

}  // namespace

struct FclArm::Parts {
  const RobotModel& robot;
  TestedLinks tested;
  std::vector<std::unique_ptr<FclModel<fcl::OBBRSSd>>> links{};
  std::vector<Geometry> geometries{};             // of these, with the volumes that are requested
  std::vector<std::optional<FclSolid>> solids{};  // of links with meshes, with their insides
  std::vector<FclObstacle> obstacles{};
  fcl::DynamicAABBTreeCollisionManagerd tree{};  // of many obstacles, otherwise empty
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> moved{};  // links, for the tree
  fcl::CollisionRequestd request{};
  std::vector<Pose> world_from_link{};
  std::vector<fcl::Transform3d> poses{};
  std::vector<Eigen::AlignedBox3d> boxes{};

  bool touch(const fcl::CollisionGeometryd* a, const fcl::Transform3d& pose_a,
             const fcl::CollisionGeometryd* b, const fcl::Transform3d& pose_b) const {
    fcl::CollisionResultd result;
    return fcl::collide(a, pose_a, b, pose_b, request, result) > 0;
  }

  bool touches(std::size_t link, const FclObstacle& obstacle) const {
    return boxes[link].intersects(obstacle.box) &&
           touch(geometries[link].get(), poses[link], obstacle.geometry.get(), obstacle.pose);
  }

  bool touches_any(std::size_t link) {
    if (tree.empty()) {
      return std::any_of(obstacles.begin(), obstacles.end(),
                         [&](const FclObstacle& obstacle) { return touches(link, obstacle); });
    }
    // The boxes that FCL gives a turned object are those of its sphere.
    moved[link]->setTransform(poses[link]);
    moved[link]->computeAABB();
    TreeQuery query{this, link, false};
    tree.collide(moved[link].get(), &query, &visit);
    return query.hit;
  }

  struct TreeQuery {
    const Parts* parts;
    std::size_t link;
    bool hit;
  };
  // True ends the search.
  static bool visit(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    TreeQuery& query = *static_cast<TreeQuery*>(data);
    const void* const obstacle = a->getUserData() != nullptr ? a->getUserData() : b->getUserData();
    query.hit = query.parts->touches(query.link, *static_cast<const FclObstacle*>(obstacle));
    return query.hit;
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
    auto object = std::make_unique<fcl::CollisionObjectd>(geometry, pose);
    object->computeAABB();
    const Eigen::AlignedBox3d box(object->getAABB().min_, object->getAABB().max_);
    parts_->obstacles.push_back({geometry, pose, box, std::move(object)});
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
  if (parts_->obstacles.size() > kFewObstacles) {
    for (FclObstacle& obstacle : parts_->obstacles) {
      obstacle.object->setUserData(&obstacle);
      parts_->tree.registerObject(obstacle.object.get());
    }
    parts_->tree.setup();
    for (const Geometry& geometry : parts_->geometries) {
      parts_->moved.push_back(geometry ? std::make_unique<fcl::CollisionObjectd>(geometry)
                                       : nullptr);
    }
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
  if (std::any_of(in.tested.moving.begin(), in.tested.moving.end(),
                  [&](std::size_t link) { return in.touches_any(link); })) {
    return true;
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
