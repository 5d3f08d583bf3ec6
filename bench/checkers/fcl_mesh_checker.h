// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/collision_geometry.h>

#include <memory>
#include <string>
#include <vector>

namespace spherule {

// FCL on the triangle meshes. A fair setting: hierarchies of oriented boxes (FCL copies and moves a
// whole model for each query with its other volumes), contacts off, one contact enough, a fresh
// result for every pair. What differs:
struct FclMeshSetting {
  enum class Volume { kObb, kObbRss };
  enum class Precision { kDouble, kFloat };  // Debian's library; instantiated here, with our flags
  // What stands in front of a mesh pair: our test of the bodies' exact axis-parallel boxes, or
  // FCL's DynamicAABBTreeCollisionManager over the obstacles.
  enum class Front { kBoxes, kManager };

  Volume volume = Volume::kObbRss;
  Precision precision = Precision::kDouble;
  Front front = Front::kBoxes;
};

std::string to_string(const FclMeshSetting& setting);
std::vector<FclMeshSetting> all_fcl_mesh_settings();
std::unique_ptr<Checker> make_fcl_mesh_checker(const Workload& workload,
                                               const FclMeshSetting& setting);

// FCL on convex parts (GJK by libccd) in place of one obstacle's mesh: the bodies and all other
// obstacles stay meshes, in hierarchies of OBBRSS in double behind exact axis-parallel boxes. The
// parts are closed, convex, with outward triangles, in the obstacle's frame. Throws Error for no
// parts.
std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts);

// FCL's queries of two meshes, both BVHModel<Volume>: until the first contact, and the distance
// without its points (FCL has none for OBB). In double precision Debian's library answers
// fcl::collide() and fcl::distance(). It has no single precision: fcl_meshes.cpp instantiates the
// functions that those two pick for meshes, and not those for every other pair of FCL's shapes.
template <class Volume>
bool fcl_meshes_touch(const fcl::CollisionGeometry<typename Volume::S>& a,
                      const fcl::Transform3<typename Volume::S>& world_from_a,
                      const fcl::CollisionGeometry<typename Volume::S>& b,
                      const fcl::Transform3<typename Volume::S>& world_from_b);
template <class Volume>
typename Volume::S fcl_mesh_distance(const fcl::CollisionGeometry<typename Volume::S>& a,
                                     const fcl::Transform3<typename Volume::S>& world_from_a,
                                     const fcl::CollisionGeometry<typename Volume::S>& b,
                                     const fcl::Transform3<typename Volume::S>& world_from_b);

}  // namespace spherule

extern template class fcl::DynamicAABBTreeCollisionManager<float>;
