// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_tree.h"

#include "collide/internal/queries.h"
#include "collide/internal/triangle_leaves.h"
#include "spheretree/build.h"
#include "spheretree/enclosing_sphere.h"

namespace spherule {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  validate(mesh, "mesh");
  std::vector<Triangle> result;
  result.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& indices : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(indices[k])]; };
    result.push_back({corner(0), corner(1), corner(2)});
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
