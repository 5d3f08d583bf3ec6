// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_tree.h"

#include "collide/internal/queries.h"
#include "collide/internal/triangle_leaves.h"
#include "spheretree/build.h"
#include "spheretree/enclosing_sphere.h"
#include "spheretree/error.h"

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

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh)
    : triangles_(triangles_of(mesh)), tree_(tree_of(triangles_)) {}

bool collides(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
              const Pose& world_from_b) noexcept {
  const RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::any_pair(a, b.tree(), pose, internal::TriangleLeaves(a, b, pose));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::all_pairs(a, b.tree(), pose, internal::TriangleLeaves(a, b, pose), request);
}

}  // namespace spherule
