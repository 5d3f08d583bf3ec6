// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_float.h"

template class fcl::DynamicAABBTreeCollisionManager<float>;
template std::size_t fcl::collide(const fcl::CollisionGeometry<float>* a,
                                  const fcl::Transform3<float>& world_from_a,
                                  const fcl::CollisionGeometry<float>* b,
                                  const fcl::Transform3<float>& world_from_b,
                                  const fcl::CollisionRequest<float>& request,
                                  fcl::CollisionResult<float>& result);
template float fcl::distance(const fcl::CollisionGeometry<float>* a,
                             const fcl::Transform3<float>& world_from_a,
                             const fcl::CollisionGeometry<float>* b,
                             const fcl::Transform3<float>& world_from_b,
                             const fcl::DistanceRequest<float>& request,
                             fcl::DistanceResult<float>& result);
