// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm.h"

#include "base/error.h"
#include "base/text.h"
#include "geometry/enclosing_sphere.h"
#include "io/mesh_io.h"
#include "robot/check/robot_collision.h"
#include "robot/cover/link_mesh.h"
#include "robot/files/urdf.h"
#include "spheretree/build.h"

#include <array>
#include <memory>
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

}  // namespace spherule
