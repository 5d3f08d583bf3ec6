// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_obstacles.h"

#include "io/sphere_file.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/link_mesh.h"
#include "spheretree/tree_file.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <variant>

namespace spherule {
namespace {

// How far triangles for curved obstacles may lie outside, as a share of their size.
constexpr double kChordShare = 0.01;
// The least side of the square that stands for a half-space, in metres.
constexpr double kLeastSide = 1.0;

double size_of(const Primitive& primitive) {
  if (const auto* cylinder = std::get_if<Cylinder>(&primitive)) return cylinder->radius;
  if (const auto* capsule = std::get_if<Capsule>(&primitive)) return capsule->radius;
  return 1.0;
}

class Obstacles {
 public:
  explicit Obstacles(const RobotModel& robot) : robot_(robot) {}

  std::vector<ViewItem> run(const SceneDescription& scene) && {
    for (const SceneObstacle& obstacle : scene.obstacles) {
      place(obstacle.name, -1, obstacle.world_from_shape);
      std::visit([this](const auto& source) { add(source); }, obstacle.shape);
    }
    for (const SceneObstacle& obstacle : scene.obstacles) {
      const auto* primitive = std::get_if<Primitive>(&obstacle.shape);
      if (primitive == nullptr || !std::holds_alternative<HalfSpace>(*primitive)) continue;
      place(obstacle.name, -1, obstacle.world_from_shape);
      add_square();
    }
    for (const SceneAttachment& object : scene.attached) {
      place(object.name, robot_.find_link(object.link), object.link_from_object);
      std::visit([this](const auto& source) { add(source); }, object.shape);
    }
    std::vector<ViewItem> items;
    if (!meshes_.parts.empty()) items.push_back(std::move(meshes_));
    if (!spheres_.parts.empty()) items.push_back(std::move(spheres_));
    return items;
  }

 private:
  void place(const std::string& name, int link, const Pose& pose) {
    name_ = name;
    link_ = link;
    pose_ = pose;
  }

  void add(const MeshFile& file) { add_shape(file, {}); }
  void add(const Primitive& primitive) {
    if (std::holds_alternative<HalfSpace>(primitive)) return;  // when all else is known
    if (const auto* sphere = std::get_if<SolidSphere>(&primitive)) {
      add_spheres(std::vector<Sphere>{{Eigen::Vector3d::Zero(), sphere->radius}});
    } else {
      add_shape(primitive, {.chord_error = kChordShare * size_of(primitive)});
    }
  }
  void add(const PointsSource& source) { add_spheres(point_spheres(source)); }
  void add(const SpheresSource& source) { add_spheres(load_spheres(source.path).spheres); }
  void add(const TreeSource& source) { add_spheres(load_tree(source.path).spheres()); }

  void add_shape(const std::variant<MeshFile, Primitive>& geometry,
                 const LinkMeshOptions& options) {
    const LinkDescription shape{
        .name = name_, .visual = {}, .collision = {LinkShape{{}, pose_, geometry}}};
    if (auto mesh = link_mesh(shape, options)) add_mesh(std::move(*mesh));
  }
  void add_mesh(TriangleMesh mesh) {
    if (link_ < 0) {
      for (const Eigen::Vector3d& vertex : mesh.vertices) box_.extend(vertex);
    }
    meshes_.parts.push_back({std::move(mesh), link_, name_});
  }
  void add_spheres(std::span<const Sphere> spheres) {
    std::vector<Sphere> placed;
    for (const Sphere& sphere : spheres) {
      placed.push_back({pose_ * sphere.center, sphere.radius});
      if (link_ < 0) box_.extend(placed.back().center);
    }
    spheres_.parts.push_back({std::move(placed), link_, name_});
  }

  // The surface of a half-space below and around the rest.
  void add_square() {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double half = 0.5 * kLeastSide;
    if (!box_.isEmpty()) {
      middle = pose_.inverse() * Eigen::Vector3d(box_.center());
      half = std::max(half, 0.75 * box_.diagonal().norm());
    }
    TriangleMesh square;
    for (const auto& [x, y] :
         {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
      square.vertices.push_back(pose_ *
                                Eigen::Vector3d(middle.x() + half * x, middle.y() + half * y, 0.0));
    }
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    meshes_.parts.push_back({std::move(square), link_, name_, true});
  }

  const RobotModel& robot_;
  ViewItem meshes_{.name = "obstacles and tools", .parts = {}};
  ViewItem spheres_{.name = "obstacles and tools of spheres", .parts = {}};
  Eigen::AlignedBox3d box_{};  // of the obstacles
  std::string name_{};         // of what is added, its link and its place
  int link_ = -1;
  Pose pose_{};
};

}  // namespace

std::vector<ViewItem> view_obstacles(const SceneDescription& scene, const RobotModel& robot) {
  return Obstacles(robot).run(scene);
}

}  // namespace spherule
