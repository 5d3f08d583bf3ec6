// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm.h"
#include "bench/studies/refined_cover.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/point_cloud.h"

#include <cmath>
#include <memory>
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

namespace {

// Bumpy spheres: closed, of many triangles of all sizes, with hollows that an arm reaches into.
constexpr int kBodies = 6;

Eigen::Vector3d center_of(int body) {
  const double angle = 2.0 * std::numbers::pi * body / kBodies;
  return {0.6 * std::cos(angle), 0.6 * std::sin(angle), body % 2 == 0 ? 0.3 : 0.7};
}

Eigen::Vector3d surface_point(int body, double latitude, double longitude) {
  const double bumps = 1.0 + 0.25 * std::sin(5.0 * longitude + body) * std::sin(4.0 * latitude);
  const double radius = 0.14 * bumps;
  return center_of(body) + radius * Eigen::Vector3d(std::sin(latitude) * std::cos(longitude),
                                                    std::sin(latitude) * std::sin(longitude),
                                                    std::cos(latitude));
}

// Rings from pole to pole, each of twice as many points.
void add_body(int body, int rings, TriangleMesh& mesh) {
  const int sectors = 2 * rings;
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 1; i < rings; ++i) {
    for (int k = 0; k < sectors; ++k) {
      mesh.vertices.push_back(
          surface_point(body, std::numbers::pi * i / rings, 2.0 * std::numbers::pi * k / sectors));
    }
  }
  const int north = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(surface_point(body, 0.0, 0.0));
  const int south = north + 1;
  mesh.vertices.push_back(surface_point(body, std::numbers::pi, 0.0));
  const auto at = [&](int ring, int sector) { return first + ring * sectors + sector % sectors; };
  for (int k = 0; k < sectors; ++k) {
    mesh.triangles.push_back({north, at(0, k), at(0, k + 1)});
    mesh.triangles.push_back({south, at(rings - 2, k + 1), at(rings - 2, k)});
    for (int i = 0; i + 1 < rings - 1; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
}

}  // namespace

ArmScene scene_of_points(std::size_t count) {
  ArmScene scene{.name = "cloud", .cloud_radius = 0.01};
  RandomNumbers random(3);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d direction = random.direction();
    const Eigen::Vector3d point =
        surface_point(static_cast<int>(i % kBodies), std::acos(direction.z()),
                      std::atan2(direction.y(), direction.x()));
    // In single precision, as sensors give it and FCL is queried with.
    scene.cloud.push_back(point.cast<float>().cast<double>());
  }
  return scene;
}

ArmScene scene_of_triangles(std::size_t count) {
  ArmScene scene{.name = "mesh"};
  const int rings = static_cast<int>(std::sqrt(static_cast<double>(count) / (4.0 * kBodies))) + 2;
  for (int body = 0; body < kBodies; ++body) add_body(body, rings, scene.mesh);
  return scene;
}

ArmScene scene_of_primitives(std::size_t count) {
  ArmScene scene{.name = "fifty"};
  RandomNumbers random(4);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d at =
        Eigen::Vector3d(0, 0, 0.5) + random.between(0.55, 1.0) * random.direction();
    const double size = random.between(0.03, 0.12);
    const Primitive kinds[] = {Box{{size, 1.5 * size, 0.7 * size}}, Cylinder{0.4 * size, size},
                               SolidSphere{0.5 * size}};
    scene.obstacles.push_back(
        {"obstacle " + std::to_string(i), kinds[i % 3], Pose(random.rotation(), at)});
  }
  return scene;
}

std::vector<ArmScene> larger_scenes() {
  return {scene_of_primitives(50), scene_of_points(4000), scene_of_triangles(20000)};
}

}  // namespace spherule
