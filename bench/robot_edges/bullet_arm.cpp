// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/bullet_pair_test.h"
#include "bench/robot_edges/peer_arms.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <bullet/BulletCollision/Gimpact/btGImpactShape.h>
#include <bullet/LinearMath/btConvexHullComputer.h>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {
namespace {

using Shape = std::unique_ptr<btCollisionShape>;

btScalar scalar(double value) {
  return static_cast<btScalar>(value);
}

template <class S, class... Values>
Shape make_shape(Values&&... values) {
  auto shape = std::make_unique<S>(std::forward<Values>(values)...);
  // A capsule's and a sphere's radius is its margin.
  if (shape->getShapeType() != CAPSULE_SHAPE_PROXYTYPE &&
      shape->getShapeType() != SPHERE_SHAPE_PROXYTYPE) {
    shape->setMargin(0);
  }
  return shape;
}

struct MakePrimitive {
  Shape operator()(const Box& box) const {
    return make_shape<btBoxShape>(bullet_vector(0.5 * box.size));
  }
  Shape operator()(const SolidSphere& sphere) const {
    return make_shape<btSphereShape>(scalar(sphere.radius));
  }
  Shape operator()(const Cylinder& solid) const {
    return make_shape<btCylinderShapeZ>(
        bullet_vector({solid.radius, solid.radius, 0.5 * solid.length}));
  }
  Shape operator()(const Capsule& solid) const {
    return make_shape<btCapsuleShapeZ>(scalar(solid.radius), scalar(solid.length));
  }
  Shape operator()(const HalfSpace&) const {
    throw std::logic_error("the scenes have no half-spaces");
  }
};

std::unique_ptr<btTriangleMesh> triangles_of(const TriangleMesh& mesh) {
  auto triangles = std::make_unique<btTriangleMesh>();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int i) {
      return bullet_vector(mesh.vertices[static_cast<std::size_t>(t[i])]);
    };
    triangles->addTriangle(corner(0), corner(1), corner(2));
  }
  return triangles;
}

Shape hull_of(const TriangleMesh& mesh) {
  std::vector<btVector3> points;
  for (const Eigen::Vector3d& vertex : mesh.vertices) points.push_back(bullet_vector(vertex));
  btConvexHullComputer hull;
  hull.compute(&points.front().x(), static_cast<int>(sizeof(btVector3)),
               static_cast<int>(points.size()), 0, 0);
  return make_shape<btConvexHullShape>(&hull.vertices[0].x(), hull.vertices.size(),
                                       static_cast<int>(sizeof(btVector3)));
}

Shape gimpact_of(btTriangleMesh& triangles) {
  auto shape = std::make_unique<btGImpactMeshShape>(&triangles);
  shape->setMargin(0);
  shape->updateBound();
  return shape;
}

// A shape at a pose, with its box along the world's axes.
class Placed {
 public:
  explicit Placed(Shape shape, std::unique_ptr<btTriangleMesh> triangles = {})
      : triangles_(std::move(triangles)), shape_(std::move(shape)) {
    object_.setCollisionShape(shape_.get());
  }

  void place(const Pose& pose) {
    object_.setWorldTransform(bullet_pose(pose));
    btVector3 low, high;
    shape_->getAabb(object_.getWorldTransform(), low, high);
    box_ = btDbvtVolume::FromMM(low, high);
  }

  btCollisionObject& object() { return object_; }
  const btDbvtVolume& box() const { return box_; }

 private:
  std::unique_ptr<btTriangleMesh> triangles_;
  Shape shape_;
  btCollisionObject object_;
  btDbvtVolume box_;
};

std::unique_ptr<Placed> placed_mesh(const TriangleMesh& mesh, BulletLinks links, bool is_obstacle) {
  if (links == BulletLinks::kHulls && !is_obstacle) {
    return std::make_unique<Placed>(hull_of(mesh));
  }
  auto triangles = triangles_of(mesh);
  Shape shape = links == BulletLinks::kHulls
                    ? make_shape<btBvhTriangleMeshShape>(triangles.get(), true)
                    : gimpact_of(*triangles);
  return std::make_unique<Placed>(std::move(shape), std::move(triangles));
}

// Keeps the obstacles whose boxes are touched.
class Candidates : public btDbvt::ICollide {
 public:
  using ICollide::Process;
  void Process(const btDbvtNode* leaf) override {
    found.push_back(static_cast<Placed*>(leaf->data));
  }

  std::vector<Placed*> found;
};

}  // namespace

struct BulletArm::Parts {
  const RobotModel& robot;
  TestedLinks tested;
  std::vector<std::unique_ptr<Placed>> links{};
  std::vector<std::unique_ptr<Placed>> obstacles{};
  btDbvt tree{};
  btNodeStack stack{};
  Candidates candidates{};
  BulletPairTest touch{};
  std::vector<Pose> world_from_link{};

  Parts(const Arm& arm, const AllowedCollisions& allowed)
      : robot(arm.model), tested(tested_links(arm, allowed)) {}

  void add(std::unique_ptr<Placed> obstacle, const Pose& pose) {
    obstacle->place(pose);
    tree.insert(obstacle->box(), obstacle.get());
    obstacles.push_back(std::move(obstacle));
  }

  bool touches_obstacle(Placed& link) {
    candidates.found.clear();
    tree.collideTVNoStackAlloc(tree.m_root, link.box(), stack, candidates);
    return std::any_of(candidates.found.begin(), candidates.found.end(),
                       [&](Placed* obstacle) { return touch(link.object(), obstacle->object()); });
  }
};

BulletArm::BulletArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene,
                     BulletLinks links)
    : links_(links), parts_(std::make_unique<Parts>(arm, allowed)) {
  for (const TriangleMesh& mesh : arm.meshes) {
    parts_->links.push_back(mesh.triangles.empty() ? nullptr : placed_mesh(mesh, links, false));
  }
  for (const PlacedPrimitive& obstacle : scene.obstacles) {
    parts_->add(std::make_unique<Placed>(std::visit(MakePrimitive(), obstacle.primitive)),
                obstacle.world_from_primitive);
  }
  for (const Eigen::Vector3d& point : scene.cloud) {
    parts_->add(std::make_unique<Placed>(make_shape<btSphereShape>(scalar(scene.cloud_radius))),
                Pose::from_translation(point));
  }
  if (!scene.mesh.triangles.empty()) parts_->add(placed_mesh(scene.mesh, links, true), Pose());
  parts_->tree.optimizeTopDown();
}

BulletArm::~BulletArm() = default;

const char* BulletArm::name() const {
  return links_ == BulletLinks::kHulls ? "Bullet hulls" : "Bullet GImpact";
}

bool BulletArm::collides(std::span<const double> configuration) {
  Parts& in = *parts_;
  forward_kinematics(in.robot, configuration, in.world_from_link);
  for (std::size_t i = 0; i < in.links.size(); ++i) {
    if (in.links[i]) in.links[i]->place(in.world_from_link[i]);
  }
  const auto intersects = [&](const auto& pair) {
    Placed& a = *in.links[pair.first];
    Placed& b = *in.links[pair.second];
    return Intersect(a.box(), b.box()) && in.touch(a.object(), b.object());
  };
  return std::any_of(in.tested.moving.begin(), in.tested.moving.end(),
                     [&](std::size_t link) { return in.touches_obstacle(*in.links[link]); }) ||
         std::any_of(in.tested.pairs.begin(), in.tested.pairs.end(), intersects);
}

}  // namespace spherule
