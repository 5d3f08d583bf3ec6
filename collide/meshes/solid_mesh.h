// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres against a mesh with its inside.
//
// @code{.cpp}
// #include <spherule/collide/meshes/solid_mesh.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::SolidMesh solid(tetrahedron);
// const std::vector<spherule::Sphere> spheres{{{0.2, 0.2, 0.2}, 0.01}};
// const spherule::SphereTree inside = spherule::build_tree(spheres);
// assert(solid.is_closed() && collides(inside, {}, solid, {}));
// assert(!collides(inside, {}, solid.mesh(), {}));  // it touches no triangle
// @endcode

#include "collide/meshes/mesh_tree.h"
#include "collide/search/query.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>

namespace spherule {

namespace internal {
class MeshInside;
}  // namespace internal

// A mesh with its inside, as an obstacle. Immutable; threads may share it.
//
// The solid is the closed set of the points within inflation() of a triangle or of the inside,
// which is that of CoveredMesh (mesh_contact.h): the points about which the winding number of a
// closed surface is not zero. It contains the mesh of the file and its inside, because inflation()
// is TriangleMesh::vertex_error. Each surface is judged by itself: overlapping ones take nothing
// from each other, whichever way they are turned, and a sealed hollow is inside, as is what it
// holds. A part with a boundary, or which cannot be turned alike, has no inside, and what lies
// within it without touching it is free. Not to be queried once it was moved
// from.
class SolidMesh {
 public:
  // Throws Error for a mesh that validate() refuses.
  explicit SolidMesh(const TriangleMesh& mesh);

  // The triangles, and by how much they are grown.
  const MeshTree& mesh() const { return mesh_; }
  double inflation() const { return inflation_; }
  // Whether every triangle is of a closed surface, and whether any is.
  bool is_closed() const;
  bool has_inside() const;

  // For queries.
  const internal::MeshInside& inside() const { return *inside_; }
  // Copies of a solid share it, and no others do.
  const std::shared_ptr<const internal::MeshInside>& shared_inside() const { return inside_; }

 private:
  friend class CoveredMesh;
  SolidMesh(const TriangleMesh& mesh, double inflation);

  MeshTree mesh_;
  double inflation_;
  std::shared_ptr<const internal::MeshInside> inside_;
};

// Whether a set of spheres and a solid, rigidly placed, overlap.
//
// G4: if a sphere and the solid have a point in common in exact arithmetic under exactly the given
// poses, the answer is true; so a sphere wholly inside collides, whatever shell it is in. G5: as
// for collides() of a MeshTree (mesh_tree.h), with inflation() beside the radius; a point that is
// nearer to the surface than rounding tells counts as inside. Allocates as collides() of two trees
// does.
bool collides(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
              const Pose& world_from_solid) noexcept;

// Whether they come within a clearance of each other: never false if the exact distance is at most
// the clearance. Throws Error as require_clearance() does.
bool within(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
            const Pose& world_from_solid, double clearance);

// Their separation distance between certified bounds, both 0 where a sphere is certainly inside;
// where it is too near the surface to tell, the lower one is 0. In `nearest`, `b` is the triangle,
// or -1 where sphere `a` is inside. The limits of the request are
// those of the search for the nearest triangle; whether a sphere is inside is queried after it.
DistanceResult distance(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
                        const Pose& world_from_solid, const DistanceRequest& request = {});

// The sphere that is deepest in the solid, up to rounding; none exactly if collides() is false.
// Examines every sphere that touches. Allocates.
std::optional<Contact> deepest_contact(const SphereTree& tree, const Pose& world_from_tree,
                                       const SolidMesh& solid, const Pose& world_from_solid);

}  // namespace spherule
