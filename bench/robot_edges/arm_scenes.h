// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "robot/check/robot_scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spherule {

struct PlacedPrimitive {
  std::string name;
  Primitive primitive;
  Pose world_from_primitive;
};

struct ArmScene {
  std::string name;
  std::vector<PlacedPrimitive> obstacles{};
  // Measured points, each with what is within cloud_radius of it, and a solid mesh, in the world.
  std::vector<Eigen::Vector3d> cloud{};
  double cloud_radius = 0.0;
  TriangleMesh mesh{};
};

// Seven scenes around an arm that stands at the origin and reaches 0.85 m, the like of those that
// planners are compared in. The same each time.
std::vector<ArmScene> primitive_scenes();

// So many boxes, cylinders and spheres about the arm.
ArmScene scene_of_primitives(std::size_t count);

// The surfaces of a few bodies about the arm, as about so many points, and as a solid mesh of about
// so many triangles.
ArmScene scene_of_points(std::size_t count);
ArmScene scene_of_triangles(std::size_t count);

// Fifty primitives, a cloud of 4,000 points and a solid mesh of 20,000 triangles.
std::vector<ArmScene> larger_scenes();

// The arm in a scene, as a RobotScene. What stands with the arm's root is not tested against the
// scene.
RobotScene robot_scene(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

}  // namespace spherule
