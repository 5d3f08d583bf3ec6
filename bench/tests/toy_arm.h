// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"
#include "spheretree/build.h"
#include "tests/support/shapes.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {

// A box on a table with two directions to slide in, and a bar that turns on it, above a fixed box.
inline Arm make_toy_arm(const TriangleMesh& bar = make_box({0.3, 0.05, 0.05})) {
  Arm arm{RobotModel("base"), {}};
  const auto add = [&](const std::string& name, const std::string& parent, Joint joint) {
    joint.name = name + "_joint";
    arm.model.add_link(name, parent, joint);
  };
  const auto slide = [](const Eigen::Vector3d& axis) {
    return Joint{.type = JointType::kPrismatic, .axis = axis, .lower = -0.8, .upper = 0.8};
  };
  add("rail", "base", slide(Eigen::Vector3d::UnitX()));
  add("box", "rail", slide(Eigen::Vector3d::UnitY()));
  add("bar", "box",
      {.type = JointType::kContinuous,
       .parent_from_joint = Pose::from_translation({0.0, 0.0, 0.2}),
       .axis = Eigen::Vector3d(0.3, 0.2, 1.0)});
  arm.meshes = {make_box({0.2, 0.2, 0.4}), {}, make_box({0.1, 0.1, 0.3}), bar};
  for (std::size_t i = 0; i < arm.meshes.size(); ++i) {
    if (arm.meshes[i].triangles.empty()) continue;
    arm.model.attach(
        arm.model.links()[i].name,
        std::make_shared<const SphereTree>(build_tree(spheres_around(arm.meshes[i], 0.03))));
  }
  return arm;
}

// Obstacles of all kinds around it; the largest is a mesh.
inline ArmScene make_toy_scene() {
  ArmScene scene{.name = "toy", .cloud_radius = 0.03};
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) scene.cloud.push_back({0.02 * i, -0.6, 0.2 - 0.02 * k});
  }
  const auto add = [&](const Primitive& primitive, const Eigen::Vector3d& at) {
    scene.obstacles.push_back({"obstacle " + std::to_string(scene.obstacles.size()), primitive,
                               Pose::from_translation(at)});
  };
  add(Box{{0.2, 0.1, 0.6}}, {0.6, 0.3, 0.1});
  add(SolidSphere{0.15}, {-0.5, 0.5, 0.1});
  add(Cylinder{0.1, 0.5}, {-0.6, -0.2, 0.1});
  add(Capsule{0.1, 0.3}, {0.5, -0.5, 0.2});
  scene.mesh = make_box({0.3, 0.2, 0.5});
  for (Eigen::Vector3d& vertex : scene.mesh.vertices) vertex += Eigen::Vector3d(0.1, 0.6, 0.1);
  return scene;
}

}  // namespace spherule::test
