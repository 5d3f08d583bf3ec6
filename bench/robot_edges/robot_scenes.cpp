// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/robot_scenes.h"

#include "collide/meshes/solid_mesh.h"
#include "collide/point_cloud.h"

#include <memory>

namespace spherule {

RobotScene robot_scene(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene) {
  RobotScene result(arm.model);
  result.set_allowed_collisions(allowed);
  result.set_link_pairs(arm.pairs);
  for (const PlacedPrimitive& obstacle : scene.obstacles) {
    result.add(obstacle.name, obstacle.primitive, obstacle.world_from_primitive);
  }
  if (!scene.cloud.empty()) {
    result.add("cloud", std::make_shared<const SphereTree>(
                            point_cloud_tree(scene.cloud, scene.cloud_radius)));
  }
  if (!scene.mesh.triangles.empty()) {
    result.add("mesh", std::make_shared<const SolidMesh>(scene.mesh));
  }
  for (int link = 0; link < static_cast<int>(arm.model.links().size()); ++link) {
    if (link != 0 && allowed.reason(0, link) != AllowedReason::kRigid) continue;
    for (const std::string& obstacle : result.obstacles()) {
      result.allow_contact(arm.model.links()[static_cast<std::size_t>(link)].name, obstacle);
    }
  }
  return result;
}

}  // namespace spherule
