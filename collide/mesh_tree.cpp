// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_tree.h"

#include "collide/internal/queries.h"
#include "spheretree/build.h"
#include "spheretree/enclosing_sphere.h"
#include "spheretree/error.h"
#include "spheretree/point_triangle.h"

#include <string>

namespace spherule {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw Error("mesh", "there is no triangle");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_usable_point(mesh.vertices[i])) {
      throw Error("mesh", "vertex " + std::to_string(i) + " is not finite or exceeds 1e15");
    }
  }
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  std::vector<Triangle> result;
  result.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles[i][k];
      if (vertex < 0 || vertex >= vertex_count) {
        throw Error("mesh",
                    "triangle " + std::to_string(i) + " has no vertex " + std::to_string(vertex));
      }
      triangle[static_cast<std::size_t>(k)] = mesh.vertices[static_cast<std::size_t>(vertex)];
    }
    result.push_back(triangle);
  }
  return result;
}

SphereTree tree_of(const std::vector<Triangle>& triangles) {
  std::vector<Sphere> balls;
  balls.reserve(triangles.size());
  for (const Triangle& triangle : triangles) balls.push_back(enclosing_sphere(triangle));
  return build_tree(balls);
}

// Leaf test of a ball against a triangle, in the triangle's frame.
//
// The image p of the ball's centre errs by less than 136 u S (collide/relative_pose.h), and `lower`
// bounds the distance from p to the triangle. So a ball of radius r that meets the triangle has
// lower <= r + 136 u S, and the pad of 144 u S covers the rounding of the sum. Conversely a hit has
// an exact gap of at most 144 u S + 136 u S + (upper - lower): the last term is below 64 u of the
// distance to the triangle's farthest corner but for needles (spheretree/point_triangle.h).
class TriangleLeaves {
 public:
  TriangleLeaves(const SphereTree& a, const MeshTree& b, const RelativePose& pose)
      : a_(a),
        b_(b),
        b_from_a_(pose.b_from_a()),
        pad_(144.0 * kUnitRoundoff * pose.scene_size() + kUnderflow) {}

  bool touches(NodePair pair) const { return lower(pair) <= radius(pair) + pad_; }
  double gap(NodePair pair) const { return lower(pair) - radius(pair); }

 private:
  double radius(NodePair pair) const { return a_.data().radius[pair.index(0)]; }

  double lower(NodePair pair) const {
    const Eigen::Vector3d c = a_.ball(pair.index(0)).center;
    const Eigen::Vector3d p(b_from_a_.x(c.x(), c.y(), c.z()), b_from_a_.y(c.x(), c.y(), c.z()),
                            b_from_a_.z(c.x(), c.y(), c.z()));
    const Triangle& corners = b_.triangle(b_.tree().sphere_index(pair.index(1)));
    return point_triangle_distance(p, corners[0], corners[1], corners[2]).lower;
  }

  const SphereTree& a_;
  const MeshTree& b_;
  const FrameChange b_from_a_;
  const double pad_;
};

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh)
    : triangles_(triangles_of(mesh)), tree_(tree_of(triangles_)) {}

bool collides(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
              const Pose& world_from_b) noexcept {
  const RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::any_pair(a, b.tree(), pose, TriangleLeaves(a, b, pose));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::all_pairs(a, b.tree(), pose, TriangleLeaves(a, b, pose), request);
}

}  // namespace spherule
