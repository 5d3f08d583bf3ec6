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

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

}  // namespace spherule
