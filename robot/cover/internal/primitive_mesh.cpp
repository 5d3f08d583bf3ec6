// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/primitive_mesh.h"

#include "spheretree/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <variant>
#include <vector>

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
