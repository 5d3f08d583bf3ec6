// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/solid_mesh.h"
#include "collide/search/relative_pose.h"
#include "geometry/sphere.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// Which spheres of a placed tree are inside a placed mesh.
//
// A sphere that no triangle intersects lies on one side of the surface, whole; so do two of them
// that share a point. So all below a node are outside if its sphere intersects no triangle and its
// centre is outside; and a sphere that intersects no triangle is outside if it overlaps a sphere
// that is. Rays are cast for what remains.
//
// In the terms of relative_pose.h, a centre's image errs by at most 136 u T. MeshInside::contains()
// is given that as 144 u T. A node's sphere of radius R intersects no triangle if the image is more
// than
// R
// + 160 u T from all of them, which leaves 24 u T for the roundings of the distance to the sphere
// of a node of the mesh: 3.5 u of at most 2 T, and 2 u T of the sum.
class SpheresInside {
 public:
  SpheresInside(const SphereTree& tree, const SolidMesh& solid, const RelativePose& pose);

  Eigen::Vector3d in_mesh(const Eigen::Vector3d& p) const { return mesh_from_tree_(p); }
  // How far the image may be off.
  double error() const { return error_; }
  // Whether a point, given in the mesh's frame and off by error(), is inside, or too near the
  // surface to tell.
  bool contains(const Eigen::Vector3d& in_mesh) const;
  // Whether it is inside for sure.
  bool certainly_contains(const Eigen::Vector3d& in_mesh) const;
  // True only if no point of the inside is in the sphere, which is off by error().
  bool is_outside_box(const Eigen::Vector3d& in_mesh, double radius) const;
  // True only if no triangle intersects the sphere, which is off by error().
  bool is_clear(const Eigen::Vector3d& in_mesh, double radius) const;

  // The first sphere that is inside, of a tree of whose spheres none intersects a triangle; -1 if
  // none.
  std::int32_t find() const;

 private:
  const SphereTree& tree_;
  const SolidMesh& solid_;
  const FrameChange mesh_from_tree_;
  const double error_;
  const double pad_;
};

// Spheres that together hold all of a solid, in its frame: a sphere around each triangle, grown as
// the solid is, and spheres around the cells of an octree that hold the inside. They stand out
// where triangles do, and at the surface by a cell, of which there are about as many as triangles:
// for a search that rules out what is not near the solid.
//
// Proof. What is within inflation() of a triangle is in its sphere. A point of the inside lies in
// the root cell, which contains inside().box(). A cell whose sphere intersects no triangle lies,
// whole, on one side: it is left out only if its centre is outside. One whose sphere may intersect
// a triangle is left out if a triangle's sphere holds all of it (those of the tree's nodes hold the
// spheres below them, so that the search for it loses none); else it is split, until it is small or
// there are too many, and then its sphere is kept.
std::vector<Sphere> spheres_around(const SolidMesh& solid);

}  // namespace spherule::internal
