// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm.h"

#include "base/error.h"
#include "base/text.h"
#include "bench/studies/refined_cover.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/point_cloud.h"
#include "geometry/sphere.h"
#include "io/mesh_io.h"
#include "robot/check/robot_collision.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace spherule {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

// The meshes of a link in its frame; shapes that are no meshes do not occur.
TriangleMesh mesh_of(const LinkDescription& link) {
  TriangleMesh result;
  for (const LinkShape& shape : link.collision) {
    const MeshFile& file = std::get<MeshFile>(shape.geometry);
    const TriangleMesh mesh = read_mesh(file.path);
    const Eigen::Vector3i first =
        Eigen::Vector3i::Constant(static_cast<int>(result.vertices.size()));
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      result.vertices.push_back(shape.link_from_shape * vertex.cwiseProduct(file.scale));
    }
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      result.triangles.push_back(triangle + first);
    }
  }
  return result;
}

// The middles of edges are rounded: pieces need not quite make up the triangle.
constexpr double kRounding = 1e-9;  // metres

// A piece whose sphere is too large is halved, at the middle of its longest edge.
void add_spheres(const Triangle& triangle, double radius, std::vector<Sphere>& spheres) {
  const Sphere sphere = enclosing_sphere(triangle);
  if (sphere.radius + kRounding <= radius) {
    spheres.push_back({sphere.center, sphere.radius + kRounding});
    return;
  }
  int longest = 0;
  const auto length = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return (triangle[(k + 1) % 3] - triangle[k]).norm();
  };
  for (const int i : {1, 2}) {
    if (length(i) > length(longest)) longest = i;
  }
  const auto k = static_cast<std::size_t>(longest);
  const Eigen::Vector3d middle = 0.5 * (triangle[k] + triangle[(k + 1) % 3]);
  add_spheres({triangle[k], middle, triangle[(k + 2) % 3]}, radius, spheres);
  add_spheres({middle, triangle[(k + 1) % 3], triangle[(k + 2) % 3]}, radius, spheres);
}

std::vector<Sphere> spheres_of(const LinkDescription& link) {
  std::vector<Sphere> spheres;
  for (const LinkShape& shape : link.collision) {
    const SolidSphere& sphere = std::get<SolidSphere>(std::get<Primitive>(shape.geometry));
    spheres.push_back({shape.link_from_shape.translation(), sphere.radius});
  }
  return spheres;
}

template <class SpheresOf>
Arm make_arm(const std::filesystem::path& models, SpheresOf spheres_of) {
  RobotDescription robot = read_urdf(models / "robots" / "franka_panda" / "franka_panda.urdf");
  Arm arm{std::move(robot.model), {}};
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const TriangleMesh& mesh = arm.meshes.emplace_back(mesh_of(robot.links[i]));
    arm.triangles += mesh.triangles.size();
    const std::vector<Sphere> spheres = spheres_of(i, mesh);
    if (spheres.empty()) continue;
    arm.spheres += spheres.size();
    const auto tree = std::make_shared<const SphereTree>(build_tree(spheres));
    if (!mesh.triangles.empty()) {
      arm.covers.push_back(std::make_shared<const CoveredMesh>(mesh, tree));
    }
    arm.model.attach(robot.links[i].name, tree);
  }
  arm.pairs = std::make_shared<const LinkPairs>(prove_link_pairs(arm.model, link_bodies(robot)));
  return arm;
}

}  // namespace

std::vector<Sphere> spheres_around(const TriangleMesh& mesh, double radius) {
  std::vector<Sphere> spheres;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    add_spheres(corners_of(mesh, t), radius, spheres);
  }
  return spheres;
}

Arm make_panda(const std::filesystem::path& models, const std::string& cover) {
  const std::optional<double> radius = internal::finite_number(cover);
  if (radius && !(*radius > 0.0)) throw Error(cover, "is not a radius");
  if (!radius) {
    const RobotDescription spheres = read_urdf(cover);
    return make_arm(models, [&](std::size_t link, const TriangleMesh&) {
      return spheres_of(spheres.links.at(link));
    });
  }
  return make_arm(
      models, [&](std::size_t, const TriangleMesh& mesh) { return spheres_around(mesh, *radius); });
}

AllowedCollisions joined_contacts(const Arm& arm) {
  AllowedCollisions allowed(arm.model);
  // How far the hand is closed is not the arm's affair.
  allowed.allow("panda_leftfinger", "panda_rightfinger");
  return allowed;
}

AllowedCollisions allowed_contacts(const Arm& arm) {
  AllowedCollisions allowed = joined_contacts(arm);
  allow_sampled(sample_collisions(arm.model, allowed, {.configurations = 2000}), allowed);
  return allowed;
}

TestedLinks tested_links(const Arm& arm, const AllowedCollisions& allowed) {
  TestedLinks result;
  for (std::size_t i = arm.meshes.size(); i-- > 0;) {
    if (arm.meshes[i].triangles.empty()) continue;
    const int link = static_cast<int>(i);
    if (!allowed.allows(0, link) || allowed.reason(0, link) != AllowedReason::kRigid) {
      result.moving.push_back(i);
    }
    for (std::size_t k = i; k-- > 0;) {
      if (arm.meshes[k].triangles.empty() || allowed.allows(link, static_cast<int>(k))) continue;
      result.pairs.emplace_back(i, k);
    }
  }
  return result;
}

namespace {

// Of any joint.
double largest_change(const Edge& edge) {
  double largest = 0.0;
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    largest = std::max(largest, std::abs(edge.to[i] - edge.from[i]));
  }
  return largest;
}

// The numbers from 1 to `steps`, the last one first and then halves of what is left.
std::vector<int> spread_out(int steps) {
  std::vector<int> order = {steps};
  std::vector<std::pair<int, int>> ranges = {{1, steps - 1}};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto [first, last] = ranges[i];
    if (first > last) continue;
    const int middle = (first + last) / 2;
    order.push_back(middle);
    ranges.emplace_back(first, middle - 1);
    ranges.emplace_back(middle + 1, last);
  }
  return order;
}

}  // namespace

Configuration random_configuration(const RobotModel& robot, RandomNumbers& random) {
  Configuration result;
  for (const int joint : robot.variable_joints()) {
    const Joint& moved = robot.joints()[static_cast<std::size_t>(joint)];
    result.push_back(random.between(moved.lower, moved.upper));
  }
  return result;
}

Edge random_edge(const RobotModel& robot, RandomNumbers& random) {
  Edge edge{random_configuration(robot, random), random_configuration(robot, random)};
  const double part = std::min(1.0, random.between(0.1, 1.5) / largest_change(edge));
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    edge.to[i] = edge.from[i] + part * (edge.to[i] - edge.from[i]);
  }
  return edge;
}

std::vector<Configuration> samples(const Edge& edge, double step) {
  const int steps = std::max(1, static_cast<int>(std::ceil(largest_change(edge) / step)));
  std::vector<Configuration> result;
  for (const int k : spread_out(steps)) {
    const double t = static_cast<double>(k) / steps;
    Configuration& at = result.emplace_back(edge.from.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = (1.0 - t) * edge.from[i] + t * edge.to[i];
    }
  }
  return result;
}

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
