// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cstddef>

// FCL in single precision, which Debian's library does not hold. fcl_float.cpp instantiates it once
// for all: a call of fcl::collide() makes the code for each pair of FCL's shapes.
extern template class fcl::DynamicAABBTreeCollisionManager<float>;
extern template std::size_t fcl::collide(const fcl::CollisionGeometry<float>* a,
                                         const fcl::Transform3<float>& world_from_a,
                                         const fcl::CollisionGeometry<float>* b,
                                         const fcl::Transform3<float>& world_from_b,
                                         const fcl::CollisionRequest<float>& request,
                                         fcl::CollisionResult<float>& result);
extern template float fcl::distance(const fcl::CollisionGeometry<float>* a,
                                    const fcl::Transform3<float>& world_from_a,
                                    const fcl::CollisionGeometry<float>* b,
                                    const fcl::Transform3<float>& world_from_b,
                                    const fcl::DistanceRequest<float>& request,
                                    fcl::DistanceResult<float>& result);
