// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "robot/pairs/allowed_collisions.h"

#include <memory>
#include <span>

namespace spherule {

// FCL's volumes around triangles that are fast on moving meshes.
enum class FclVolume { kObb, kObbRss };

// The arm's meshes in a scene, and against each other where this is not allowed, by FCL in
// double, with a test of boxes along the world's axes in front (of many obstacles: behind FCL's
// dynamic AABB tree of them). What tells a link inside another
// one or inside the scene's mesh is not queried; primitives are solid to FCL, and so are the
// spheres about the points of a cloud.
class FclArm : public ArmChecker {
 public:
  FclArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene, FclVolume volume);
  ~FclArm() override;

  const char* name() const override;
  bool collides(std::span<const double> configuration) override;
  // Whether the middle of an obstacle is inside of a link, which surfaces do not tell.
  bool holds_an_obstacle(std::span<const double> configuration);

 private:
  struct Parts;
  FclVolume volume_;
  std::unique_ptr<Parts> parts_;
};

// What a link is to Bullet.
enum class BulletLinks {
  kHulls,    // the convex hull of its mesh, as PyBullet and Tesseract have it: another geometry
  kGImpact,  // its triangles (btGImpactMeshShape), the only moving ones that Bullet has
};

// The arm in a scene, and against itself where this is not allowed, by Bullet (single precision, as
// Debian packages it): margins zero, the obstacles in a dynamic AABB tree of Bullet, what it leaves
// by contactPairTest, until a pair touches. Primitives are solid, and so are the spheres about the
// points of a cloud; the scene's mesh is its triangles, a btBvhTriangleMeshShape to hulls.
class BulletArm : public ArmChecker {
 public:
  BulletArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene,
            BulletLinks links);
  ~BulletArm() override;

  const char* name() const override;
  bool collides(std::span<const double> configuration) override;

 private:
  struct Parts;
  BulletLinks links_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace spherule
