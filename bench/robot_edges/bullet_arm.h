// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"

#include <memory>
#include <span>

namespace spherule {

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
