// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm_scenes.h"
#include "bench/studies/random_numbers.h"

#include <cmath>
#include <numbers>

namespace spherule {
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
