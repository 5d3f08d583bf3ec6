// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cstddef>

// FCL in single precision, which Debian's library does not hold. fcl_float.cpp instantiates it once
// for all: a call of fcl::collide() makes the code for each pair of FCL's shapes.
namespace fcl {

extern template class DynamicAABBTreeCollisionManager<float>;
extern template std::size_t collide(const CollisionGeometry<float>* a,
                                    const Transform3<float>& world_from_a,
                                    const CollisionGeometry<float>* b,
                                    const Transform3<float>& world_from_b,
                                    const CollisionRequest<float>& request,
                                    CollisionResult<float>& result);
extern template float distance(const CollisionGeometry<float>* a,
                               const Transform3<float>& world_from_a,
                               const CollisionGeometry<float>* b,
                               const Transform3<float>& world_from_b,
                               const DistanceRequest<float>& request,
                               DistanceResult<float>& result);

}  // namespace fcl
