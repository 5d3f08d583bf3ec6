// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres against the surface of a mesh.
//
// @code{.cpp}
// #include <spherule/collide/meshes/mesh_tree.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::MeshTree surface(tetrahedron);
// const std::vector<spherule::Sphere> spheres{{{0, 0, -2}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// assert(!collides(tree, {}, surface, {}));
// assert(within(tree, {}, surface, {}, 1.0) && distance(tree, {}, surface, {}).upper < 1.001);
// @endcode

#include "collide/search/query.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace spherule {

namespace internal {
class NodeBoxes;
class PackedMesh;
}  // namespace internal

// A sphere tree whose leaves are triangles: every leaf sphere encloses one triangle. Immutable. The
// mesh is judged as stored: its vertex_error, the distance to the file's mesh, is not added to it.
// Threads may share it. Not to be queried once it was moved from.
class MeshTree {
 public:
  // Throws Error for a mesh that validate() refuses.
  explicit MeshTree(const TriangleMesh& mesh);

  // triangle(index) is triangle `index` of the mesh; sphere `index` of tree() encloses it.
  const SphereTree& tree() const { return tree_; }
  const std::array<Eigen::Vector3d, 3>& triangle(std::int32_t index) const {
    return triangles_[static_cast<std::size_t>(index)];
  }

  // For queries: one vertex of every connected component, the farthest from the middle of the mesh,
  // as most often it is far from what the mesh touches.
  std::span<const Eigen::Vector3d> component_points() const { return component_points_; }
  const internal::NodeBoxes& node_boxes() const { return *node_boxes_; }
  const internal::PackedMesh& packed() const { return *packed_; }

 private:
  std::vector<std::array<Eigen::Vector3d, 3>> triangles_;
  SphereTree tree_;  // sphere i is the sphere of triangle i
  std::vector<Eigen::Vector3d> component_points_;
  std::shared_ptr<const internal::NodeBoxes> node_boxes_;
  std::shared_ptr<const internal::PackedMesh> packed_;
};

// Whether a set of spheres and the surface of a mesh meet, triangles in the place of the second
// set's spheres: what intersects_triangle() says of all pairs. G4 as for collides(). G5 up to the
// width of the interval in which point_triangle_distance() leaves the distance: with R the distance
// from the sphere's centre to the triangle's farthest corner, some 64 u R where the centre is not
// near the triangle; nearer it is wider, in our tests at most 1e-6 R, for needles 1e-4 R. Allocates
// as collides() does. A sphere wholly inside a closed mesh does not meet its surface. In a pair,
// `b` is the triangle.
bool collides(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
              const Pose& world_from_b) noexcept;
CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const CollisionRequest& request = {});

// Whether they come within a clearance of each other: never false if the exact gap is at most the
// clearance, and true for a greater one only as collides() is. Throws Error as require_clearance()
// does.
bool within(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
            const Pose& world_from_b, double clearance);

// Their separation distance between certified bounds, as far apart as those of
// point_triangle_distance(). In `nearest`, `b` is the triangle.
DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const DistanceRequest& request = {});

// The test that collides() and collide() rest on, for one sphere and one triangle.
bool intersects_triangle(const SphereTree& a, std::int32_t sphere, const Pose& world_from_a,
                         const MeshTree& b, std::int32_t triangle,
                         const Pose& world_from_b) noexcept;

}  // namespace spherule
