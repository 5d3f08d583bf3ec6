// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_tree.h"

#include "collide/meshes/mesh_search.h"
#include "collide/meshes/packed_mesh.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/pair_space.h"
#include "collide/search/queries.h"
#include "collide/within.h"
#include "spheretree/build.h"
#include "spheretree/enclosing_sphere.h"

namespace spherule {
namespace {

using Triangle = internal::Triangle;

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  validate(mesh, "mesh");
  std::vector<Triangle> result;
  result.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& indices : mesh.triangles) result.push_back(corners_of(mesh, indices));
  return result;
}

SphereTree tree_of(const std::vector<Triangle>& triangles) {
  std::vector<Sphere> spheres;
  spheres.reserve(triangles.size());
  for (const Triangle& triangle : triangles) spheres.push_back(enclosing_sphere(triangle));
  return build_tree(spheres);
}

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh)
    : triangles_(triangles_of(mesh)),
      tree_(tree_of(triangles_)),
      packed_(std::make_shared<const internal::PackedMesh>(triangles_, tree_.spheres())) {}

bool collides(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
              const Pose& world_from_b) noexcept {
  return internal::collides_by(internal::best_mesh_kernel(), a, world_from_a, b, world_from_b);
}

bool within(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return internal::collides_by(internal::best_mesh_kernel(), a, world_from_a, b, world_from_b,
                               clearance);
}

DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  const internal::TriangleLeaves leaves(a, b, pose);
  const internal::PairSpace space(a, b.tree(), pose, leaves);
  return internal::NearestFirst(space, pose.gap_error(), request)
      .run(internal::NodePair(0, 0), pose.gap(a.sphere(0), b.tree().sphere(0)));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::all_pairs(a, b.tree(), pose, internal::TriangleLeaves(a, b, pose), request);
}

bool intersects_triangle(const SphereTree& a, std::int32_t sphere, const Pose& world_from_a,
                         const MeshTree& b, std::int32_t triangle,
                         const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::TriangleLeaves(a, b, pose).touches(sphere, triangle);
}

}  // namespace spherule
