// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/listed_triangles.h"

#include "collide/internal/mesh_inside.h"
#include "spheretree/point_triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// The image of the other mesh's ball.
class BallFilter {
 public:
  BallFilter(const Vector3d& center, double radius, double pad)
      : center_(center), reach_(radius + pad) {}

  bool rejects(const PatchNode& box) const {
    double square = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double gap = std::max(0.0, std::abs(center_[k] - box.center[k]) - box.half[k]);
      square += gap * gap;
    }
    return square > reach_ * reach_;
  }
  bool rejects(const Triangle& t) const {
    return point_triangle_distance(center_, t[0], t[1], t[2]).lower > reach_;
  }

 private:
  Vector3d center_;
  double reach_;
};

// The image of a triangle of the other mesh: keeps off boxes by their axes and by its plane.
class TriangleFilter {
 public:
  TriangleFilter(const Triangle& image, double pad)
      : normal_((image[1] - image[0]).cross(image[2] - image[1])),
        size_(normal_.cwiseAbs()),
        low_(image[0].cwiseMin(image[1]).cwiseMin(image[2]).array() - pad),
        high_(image[0].cwiseMax(image[1]).cwiseMax(image[2]).array() + pad),
        plane_(normal_.dot(image[0])) {
    // The three corners lie in the plane but for rounding.
    const double spread = std::max(std::abs(normal_.dot(image[1]) - plane_),
                                   std::abs(normal_.dot(image[2]) - plane_));
    plane_pad_ = spread + size_.sum() * pad + kUnderflow;
  }

  bool rejects(const PatchNode& box) const {
    bool apart = false;
    double reach = plane_pad_;
    double height = -plane_;
    for (int k = 0; k < 3; ++k) {
      apart |= box.center[k] - box.half[k] > high_[k];
      apart |= box.center[k] + box.half[k] < low_[k];
      reach += size_[k] * box.half[k];
      height += normal_[k] * box.center[k];
    }
    return apart || std::abs(height) > reach;
  }

 private:
  Vector3d normal_;
  Vector3d size_;  // of the normal's entries
  Vector3d low_;
  Vector3d high_;
  double plane_;
  double plane_pad_;
};

}  // namespace

ListedTriangles::ListedTriangles(const CoveredMesh& a, const Pose& world_from_a,
                                 const CoveredMesh& b, const Pose& world_from_b,
                                 const RelativePose& pose)
    : a_{a, a.patches(), world_from_a.matrix(),
         0.5 * (world_from_a.translation() - world_from_b.translation()), pose.a_from_b()},
      b_{b, b.patches(), world_from_b.matrix(),
         0.5 * (world_from_b.translation() - world_from_a.translation()), pose.b_from_a()},
      scene_size_(pose.scene_size()),
      corner_pad_(pose.leaf_pad()),
      image_pad_(kImagePad * pose.scene_size() + kUnderflow) {}

Triangle ListedTriangles::Side::placed(std::int32_t triangle) const {
  const Triangle& corners = mesh.mesh().triangle(triangle);
  Triangle result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = rotation * corners[k] + shift;
  return result;
}

Vector3d ListedTriangles::Side::image_of(const Vector3d& p) const {
  return {from_other.x(p.x(), p.y(), p.z()), from_other.y(p.x(), p.y(), p.z()),
          from_other.z(p.x(), p.y(), p.z())};
}

bool ListedTriangles::touch(std::int32_t sphere_a, std::int32_t sphere_b) const {
  if (a_.mesh.triangles_under(sphere_a).size() < b_.mesh.triangles_under(sphere_b).size()) {
    return touch(b_, sphere_b, a_, sphere_a);
  }
  return touch(a_, sphere_a, b_, sphere_b);
}

bool ListedTriangles::touch(const Side& large, std::int32_t large_sphere, const Side& small,
                            std::int32_t small_sphere) const {
  const Sphere large_ball = large.ball(large_sphere);
  const Sphere small_ball = small.ball(small_sphere);
  const BallFilter in_large(large.image_of(small_ball.center), small_ball.radius, image_pad_);
  const BallFilter in_small(small.image_of(large_ball.center), large_ball.radius, image_pad_);
  const auto is_near = [&](std::int32_t t) {
    return !in_large.rejects(large.mesh.mesh().triangle(t));
  };
  const auto is_far = [&](const PatchNode& box) { return in_large.rejects(box); };
  if (!large.patches.any(large_sphere, is_far, is_near)) return false;

  const auto touches_large = [&](std::int32_t small_triangle) {
    const Triangle& corners = small.mesh.mesh().triangle(small_triangle);
    if (in_small.rejects(corners)) return false;
    const TriangleFilter filter(
        {large.image_of(corners[0]), large.image_of(corners[1]), large.image_of(corners[2])},
        image_pad_);
    const Triangle placed = small.placed(small_triangle);
    return large.patches.any(
        large_sphere,
        [&](const PatchNode& box) { return filter.rejects(box) || in_large.rejects(box); },
        [&](std::int32_t large_triangle) {
          return triangle_contact(large.placed(large_triangle), placed, corner_pad_, scene_size_) !=
                 TriangleContact::kApart;
        });
  };
  return small.patches.any(
      small_sphere, [&](const PatchNode& box) { return in_small.rejects(box); }, touches_large);
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
