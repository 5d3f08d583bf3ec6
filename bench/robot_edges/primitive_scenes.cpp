// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm_scenes.h"
#include "bench/studies/random_numbers.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace spherule {
namespace {

class SceneMaker {
 public:
  explicit SceneMaker(std::string name) : scene_{.name = std::move(name)} {}

  SceneMaker& add(const Primitive& primitive, const Eigen::Vector3d& at,
                  const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
    scene_.obstacles.push_back(
        {"obstacle " + std::to_string(scene_.obstacles.size()), primitive, Pose(turned, at)});
    return *this;
  }
  SceneMaker& box(const Eigen::Vector3d& size, const Eigen::Vector3d& at) {
    return add(Box{size}, at);
  }
  ArmScene done() { return std::move(scene_); }

 private:
  ArmScene scene_;
};

// Boards of 20 mm.
ArmScene shelf() {
  SceneMaker scene("shelf");
  for (const double z : {0.2, 0.5, 0.8, 1.1}) scene.box({0.3, 1.0, 0.02}, {0.65, 0, z});
  for (const double y : {-0.5, 0.5}) scene.box({0.3, 0.02, 1.2}, {0.65, y, 0.6});
  return scene.done();
}

ArmScene table() {
  SceneMaker scene("table");
  scene.box({0.6, 1.2, 0.03}, {0.65, 0, 0.3});
  for (const double y : {-0.3, 0.0, 0.3}) scene.add(Cylinder{0.04, 0.2}, {0.55, y, 0.42});
  scene.box({0.2, 0.2, 0.2}, {0.7, 0.15, 0.42});
  return scene.done();
}

// Bars of 10 mm on all sides.
ArmScene cage() {
  SceneMaker scene("cage");
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 16.0;
    scene.add(Cylinder{0.005, 1.4}, {0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.7});
  }
  return scene.done();
}

ArmScene passage() {
  SceneMaker scene("passage");
  for (const double y : {-0.45, 0.45}) scene.box({1.0, 0.5, 0.01}, {0.5, y, 0.6});
  for (const double y : {-0.2, 0.2}) scene.box({1.0, 0.01, 0.6}, {0.5, y, 0.9});
  return scene.done();
}

ArmScene pillars() {
  SceneMaker scene("pillars");
  for (int i = 0; i < 6; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 6.0;
    scene.add(Capsule{0.05, 0.9}, {0.45 * std::cos(angle), 0.45 * std::sin(angle), 0.5});
  }
  return scene.done();
}

ArmScene spheres() {
  SceneMaker scene("spheres");
  RandomNumbers random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d at =
        Eigen::Vector3d(0, 0, 0.5) + random.between(0.4, 0.9) * random.direction();
    scene.add(SolidSphere{random.between(0.03, 0.12)}, at);
  }
  return scene.done();
}

ArmScene clutter() {
  SceneMaker scene("clutter");
  RandomNumbers random(2);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d at =
        Eigen::Vector3d(0, 0, 0.5) + random.between(0.4, 0.9) * random.direction();
    const double size = random.between(0.05, 0.2);
    const Primitive kinds[] = {Box{{size, 0.1 * size, 1.5 * size}},
                               Cylinder{0.2 * size, 2.0 * size}, Capsule{0.1 * size, 2.0 * size}};
    scene.add(kinds[i % 3], at, random.rotation());
  }
  return scene.done();
}

}  // namespace

std::vector<ArmScene> primitive_scenes() {
  return {shelf(), table(), cage(), passage(), pillars(), spheres(), clutter()};
}

}  // namespace spherule
