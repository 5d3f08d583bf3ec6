// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "collide/meshes/solid_mesh.h"
#include "io/mesh_io.h"
#include "robot/cover/link_parts.h"
#include "robot/cover/robot_spheres.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {
namespace {

// The largest distance of a vertex from the origin.
double size_of(const TriangleMesh& mesh) {
  double size = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) size = std::max(size, norm_upper(v));
  return size;
}

// Of the numbers of a 3MF file, which read_mesh() leaves as they are; of the others that state a
// unit it makes metres.
double metres_per_unit(const std::filesystem::path& path) {
  constexpr double kMicrometres = 1e6;
  if (internal::lower_extension(path) != "3mf") return 1.0;
  return stated_unit(path)->micrometres / kMicrometres;
}

// A factor is off by 2^-53 of itself as it was read from text, and the product by as much.
void scale(TriangleMesh& mesh, const Eigen::Vector3d& factors) {
  if (factors == Eigen::Vector3d::Ones()) return;
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(factors);
  mesh.vertex_error = add_up(mul_up(mesh.vertex_error, factors.cwiseAbs().maxCoeff()),
                             3.0 * kUnitRoundoff * size_of(mesh) + kUnderflow);
  if (factors.prod() > 0.0) return;
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
}

void place(TriangleMesh& mesh, const Pose& link_from_shape) {
  // Pose::operator*.
  const double moved = size_of(mesh) + norm_upper(link_from_shape.translation());
  mesh.vertex_error = add_up(mesh.vertex_error, 41.0 * kUnitRoundoff * moved);
  for (Eigen::Vector3d& v : mesh.vertices) v = link_from_shape * v;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
  if (part.vertices.size() > kMost - mesh.vertices.size()) {
    throw Error(subject, "has too many vertices");
  }
  const auto first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Eigen::Vector3i& t : part.triangles) {
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
  mesh.vertex_error = std::max(mesh.vertex_error, part.vertex_error);
}

struct MeshOf {
  double chord_error;
  double weld;
  const std::string& subject;

  TriangleMesh operator()(const MeshFile& file) const {
    if (!file.scale.allFinite() || file.scale.cwiseAbs().minCoeff() == 0.0) {
      throw Error(subject, "the scale of " + file.path.string() + " must be finite and not 0");
    }
    const double unit = metres_per_unit(file.path);
    TriangleMesh mesh =
        read_mesh(file.path, {.scale = unit, .weld = weld / file.scale.cwiseAbs().maxCoeff()});
    // The unit is off by 2^-53 of itself.
    if (unit != 1.0) {
      mesh.vertex_error = add_up(mesh.vertex_error, 2.0 * kUnitRoundoff * size_of(mesh));
    }
    scale(mesh, file.scale);
    validate(mesh, file.path.string() + " as scaled");
    return mesh;
  }
  TriangleMesh operator()(const Primitive& primitive) const {
    return internal::mesh_around(primitive, chord_error, subject);
  }
};

}  // namespace

std::span<const LinkShape> link_shapes(const LinkDescription& link, LinkGeometry geometry) {
  return geometry == LinkGeometry::kCollision ? link.collision : link.visual;
}

std::optional<TriangleMesh> link_mesh(const LinkDescription& link, const LinkMeshOptions& options) {
  const std::span<const LinkShape> shapes = link_shapes(link, options.geometry);
  if (shapes.empty()) return std::nullopt;
  const std::string subject = internal::subject_of(link.name);
  TriangleMesh mesh;
  for (const LinkShape& shape : shapes) {
    TriangleMesh part =
        std::visit(MeshOf{options.chord_error, options.weld, subject}, shape.geometry);
    place(part, shape.link_from_shape);
    append(mesh, part, subject);
  }
  validate(mesh, subject);
  return mesh;
}

std::optional<LinkBody> link_body(const RobotDescription& robot, int link,
                                  const LinkMeshOptions& options, double padding) {
  if (!(padding >= 0.0) || !std::isfinite(padding)) {
    throw Error("padding", "must be at least 0 and finite");
  }
  std::optional<TriangleMesh> mesh =
      link_mesh(robot.links.at(static_cast<std::size_t>(link)), options);
  if (!mesh) return std::nullopt;
  mesh->vertex_error = add_up(mesh->vertex_error, padding);
  return LinkBody{.link = link, .mesh = std::make_shared<const SolidMesh>(*mesh)};
}

std::vector<LinkBody> link_bodies(const RobotDescription& robot, const LinkMeshOptions& options,
                                  double padding) {
  std::vector<LinkBody> bodies;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link) {
    if (auto body = link_body(robot, link, options, padding)) bodies.push_back(std::move(*body));
  }
  return bodies;
}

}  // namespace spherule

namespace spherule::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kLeastSides = 8;
constexpr int kMostSides = 1024;

// `count` directions at equal angles from (1, 0) on; count is 4 or 6 times a power of two. Halving
// adds some 4 u to the error of a direction and, where the angle is wide, a share of what its
// neighbours have: below 2^-46 after the 9 halvings that kMostSides takes.
std::vector<Vector2d> directions(int count) {
  const double height = std::sqrt(0.75);
  std::vector<Vector2d> circle = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  if (count % 3 == 0) {
    circle = {{1, 0}, {0.5, height}, {-0.5, height}, {-1, 0}, {-0.5, -height}, {0.5, -height}};
  }
  while (static_cast<int>(circle.size()) < count) {
    std::vector<Vector2d> halved;
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const Vector2d sum = circle[i] + circle[(i + 1) % circle.size()];
      halved.push_back(circle[i]);
      halved.push_back(sum / std::sqrt(sum.x() * sum.x() + sum.y() * sum.y()));
    }
    circle = std::move(halved);
  }
  return circle;
}

// Circumscribed over inscribed radius of a regular polygon.
double corner_factor(int sides) {
  return 1.0 / directions(2 * sides)[1].x();
}

// The next of 8, 12, 16, 24, 32, ...
int more_sides(int sides) {
  return sides % 3 == 0 ? sides / 3 * 4 : sides / 2 * 3;
}

enum class ProfileKind { kStraight, kRounded };

// The fewest sides with which no corner stands out of the primitive by more than `chord_error`.
// Those of a rounded profile, a polygon itself, stand out twice.
int sides_for(double radius, ProfileKind kind, double chord_error, const std::string& subject) {
  for (int sides = kLeastSides; sides <= kMostSides; sides = more_sides(sides)) {
    const double factor = corner_factor(sides);
    const double farthest = kind == ProfileKind::kRounded ? factor * factor : factor;
    if (radius * (farthest - 1.0) <= chord_error) return sides;
  }
  std::ostringstream reason;
  reason << "a radius of " << radius << " with a chord error of " << chord_error
         << " requires too many triangles";
  throw Error(subject, reason.str());
}

// The profile curve of a solid of revolution, from the top down to the bottom: x is the radius of
// the circle at height y.
using Profile = std::vector<Vector2d>;

// Tangents of a half circle, at equal angles, the first and last level; the halves are `length`
// apart. There are as many tangents to the half circle as sides to half a ring.
Profile rounded_profile(double radius, double length, int sides) {
  const std::vector<Vector2d> circle = directions(2 * sides);
  const double corner = radius * corner_factor(sides);
  Profile profile;
  for (int k = 1; k < sides; k += 2) {
    const Vector2d& direction = circle[static_cast<std::size_t>(k)];  // x up, y to the side
    const double shift = k < sides / 2 ? length / 2 : -length / 2;
    profile.push_back({corner * direction.y(), corner * direction.x() + shift});
  }
  return profile;
}

TriangleMesh revolve(const Profile& profile, int sides) {
  const std::vector<Vector2d> circle = directions(sides);
  const double factor = corner_factor(sides);
  const int rings = static_cast<int>(profile.size());
  TriangleMesh mesh;
  for (const Vector2d& point : profile) {
    for (const Vector2d& direction : circle) {
      const Vector2d corner = point.x() * factor * direction;
      mesh.vertices.push_back({corner.x(), corner.y(), point.y()});
    }
  }
  const int top = rings * sides;
  const int bottom = top + 1;
  mesh.vertices.push_back({0, 0, profile.front().y()});
  mesh.vertices.push_back({0, 0, profile.back().y()});
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    mesh.triangles.push_back({top, i, next});
    for (int upper = 0; upper + sides < top; upper += sides) {
      const int lower = upper + sides;
      mesh.triangles.push_back({upper + i, lower + i, lower + next});
      mesh.triangles.push_back({upper + i, lower + next, upper + next});
    }
    mesh.triangles.push_back({bottom, top - sides + next, top - sides + i});
  }
  // A corner is a product of the size with two factors and a direction, each off by less than
  // 2^-46, and a sum.
  double largest = 0.0;
  for (const Vector3d& v : mesh.vertices) largest = std::max(largest, v.norm());
  mesh.vertex_error = 0x1p-43 * largest;
  return mesh;
}

struct MeshAround {
  double chord_error;
  const std::string& subject;

  TriangleMesh operator()(const Box& box) const {
    // Corner k has the signs of its bits.
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
      const Vector3d sign(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
      mesh.vertices.push_back(sign.cwiseProduct(box.size));
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
  }
  TriangleMesh operator()(const SolidSphere& sphere) const { return rounded(sphere.radius, 0.0); }
  TriangleMesh operator()(const Capsule& capsule) const {
    return rounded(capsule.radius, capsule.length);
  }
  TriangleMesh operator()(const Cylinder& cylinder) const {
    const int sides = sides_for(cylinder.radius, ProfileKind::kStraight, chord_error, subject);
    return revolve(
        {{cylinder.radius, cylinder.length / 2}, {cylinder.radius, -cylinder.length / 2}}, sides);
  }
  TriangleMesh operator()(const HalfSpace&) const {
    throw Error(subject, "a half-space has no end and cannot be covered");
  }

  TriangleMesh rounded(double radius, double length) const {
    const int sides = sides_for(radius, ProfileKind::kRounded, chord_error, subject);
    return revolve(rounded_profile(radius, length, sides), sides);
  }
};

}  // namespace

TriangleMesh mesh_around(const Primitive& primitive, double chord_error,
                         const std::string& subject) {
  if (!(chord_error > 0.0)) throw Error(subject, "the chord error must be positive");
  require_primitive(primitive, subject);
  return std::visit(MeshAround{chord_error, subject}, primitive);
}

}  // namespace spherule::internal
