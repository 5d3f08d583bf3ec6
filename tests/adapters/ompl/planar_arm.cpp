// SPDX-License-Identifier: BSD-3-Clause
#include "tests/adapters/ompl/planar_arm.h"

#include "robot/check/robot_scene.h"
#include "spheretree/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

constexpr double kLength = 0.5;
constexpr double kSphere = 0.05;
constexpr int kSpheres = 11;
constexpr double kWallSphere = 0.06;
constexpr double kWallBegin = 0.95, kWallStep = 0.08;
constexpr int kWallSpheres = 9;

std::shared_ptr<const SphereTree> row(double begin, double step, int count, double radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) spheres.push_back({{begin + step * i, 0.0, 0.0}, radius});
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

}  // namespace

RobotChecker planar_arm() {
  RobotModel robot("base");
  std::string parent = "base";
  for (int i = 0; i < kArmJoints; ++i) {
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = i == 0 ? JointType::kContinuous : JointType::kRevolute;
    joint.parent_from_joint = Pose::from_translation({i == 0 ? 0.0 : kLength, 0.0, 0.0});
    joint.lower = -std::numbers::pi;
    joint.upper = std::numbers::pi;
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, parent, joint);
    robot.attach(link, row(0.0, kLength / (kSpheres - 1), kSpheres, kSphere));
    parent = link;
  }
  RobotScene scene(robot);
  scene.add("wall", row(kWallBegin, kWallStep, kWallSpheres, kWallSphere));
  return scene.snapshot();
}

double planar_arm_gap(std::span<const double> configuration) {
  double gap = std::numeric_limits<double>::infinity();
  double x = 0.0, y = 0.0, angle = 0.0;
  for (const double turn : configuration) {
    angle += turn;
    for (int i = 0; i < kSpheres; ++i) {
      const double along = kLength * i / (kSpheres - 1);
      for (int k = 0; k < kWallSpheres; ++k) {
        const double dx = x + along * std::cos(angle) - (kWallBegin + kWallStep * k);
        const double dy = y + along * std::sin(angle);
        gap = std::min(gap, std::hypot(dx, dy) - kSphere - kWallSphere);
      }
    }
    x += kLength * std::cos(angle);
    y += kLength * std::sin(angle);
  }
  return gap;
}

}  // namespace spherule::test
