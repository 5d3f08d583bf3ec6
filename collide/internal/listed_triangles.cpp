// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/listed_triangles.h"

#include "collide/internal/mesh_inside.h"
#include "spheretree/point_triangle.h"

#include <algorithm>

namespace spherule::internal {

using Eigen::Vector3d;

ListedTriangles::ListedTriangles(const CoveredMesh& a, const Pose& world_from_a,
                                 const CoveredMesh& b, const Pose& world_from_b,
                                 const RelativePose& pose)
    : a_{a, world_from_a.matrix(), 0.5 * (world_from_a.translation() - world_from_b.translation()),
         pose.a_from_b()},
      b_{b, world_from_b.matrix(), 0.5 * (world_from_b.translation() - world_from_a.translation()),
         pose.b_from_a()},
      scene_size_(pose.scene_size()),
      corner_pad_(pose.leaf_pad()),
      image_pad_(144.0 * kUnitRoundoff * pose.scene_size() + kUnderflow) {}

Triangle ListedTriangles::Side::placed(const Triangle& triangle) const {
  Triangle result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = rotation * triangle[k] + shift;
  return result;
}

Vector3d ListedTriangles::Side::image_of(const Vector3d& p) const {
  return {from_other.x(p.x(), p.y(), p.z()), from_other.y(p.x(), p.y(), p.z()),
          from_other.z(p.x(), p.y(), p.z())};
}

void ListedTriangles::collect(const Side& side, std::span<const std::int32_t> listed,
                              const Sphere& ball, std::size_t& next, Block& block) const {
  const MeshTree& mesh = side.mesh.mesh();
  const double reach = ball.radius + image_pad_;
  block.count = 0;
  for (; next < listed.size() && block.count < kBlock; ++next) {
    const std::int32_t index = listed[next];
    const Sphere& around = mesh.tree().spheres()[static_cast<std::size_t>(index)];
    const double limit = (around.radius + reach) * kRelativeUp;
    if ((around.center - ball.center).squaredNorm() > limit * limit) continue;
    const Triangle& t = mesh.triangle(index);
    if (point_triangle_distance(ball.center, t[0], t[1], t[2]).lower > reach) continue;
    block.triangles[block.count++] = side.placed(t);
  }
}

bool ListedTriangles::touch(const Block& a, const Block& b) const {
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t j = 0; j < b.count; ++j) {
      if (triangle_contact(a.triangles[i], b.triangles[j], corner_pad_, scene_size_) !=
          TriangleContact::kApart) {
        return true;
      }
    }
  }
  return false;
}

bool ListedTriangles::touch(std::int32_t sphere_a, std::int32_t sphere_b) const {
  const auto placed_ball = [](const Side& side, const CoveredMesh& other, std::int32_t sphere) {
    const Sphere& ball = other.cover().spheres()[static_cast<std::size_t>(sphere)];
    return Sphere{side.image_of(ball.center), ball.radius};
  };
  const Sphere ball_of_b = placed_ball(a_, b_.mesh, sphere_b);
  const Sphere ball_of_a = placed_ball(b_, a_.mesh, sphere_a);
  const std::span<const std::int32_t> listed_a = a_.mesh.triangles_under(sphere_a);
  const std::span<const std::int32_t> listed_b = b_.mesh.triangles_under(sphere_b);
  Block near_a, near_b;
  for (std::size_t i = 0; i < listed_a.size();) {
    collect(a_, listed_a, ball_of_b, i, near_a);
    if (near_a.count == 0) continue;
    for (std::size_t j = 0; j < listed_b.size();) {
      collect(b_, listed_b, ball_of_a, j, near_b);
      if (touch(near_a, near_b)) return true;
    }
  }
  return false;
}

bool ListedTriangles::holds_a_component(const Side& side, const CoveredMesh& other) const {
  const MeshInside& inside = side.mesh.inside();
  if (!inside.has_inside()) return false;
  const std::span<const Vector3d> points = other.inside().component_points();
  return std::any_of(points.begin(), points.end(), [&](const Vector3d& point) {
    return inside.contains(side.mesh.mesh(), side.image_of(point), image_pad_);
  });
}

bool ListedTriangles::contained() const {
  return holds_a_component(a_, b_.mesh) || holds_a_component(b_, a_.mesh);
}

}  // namespace spherule::internal
