// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm_checker.h"
#include "bench/robot_edges/arm_scenes.h"

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

}  // namespace spherule
