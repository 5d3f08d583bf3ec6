// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/collision_geometry.h>

namespace spherule {

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
