// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_float.h"

namespace fcl {

template class DynamicAABBTreeCollisionManager<float>;
template std::size_t collide(const CollisionGeometry<float>* a,
                             const Transform3<float>& world_from_a,
                             const CollisionGeometry<float>* b,
                             const Transform3<float>& world_from_b,
                             const CollisionRequest<float>& request,
                             CollisionResult<float>& result);
template float distance(const CollisionGeometry<float>* a, const Transform3<float>& world_from_a,
                        const CollisionGeometry<float>* b, const Transform3<float>& world_from_b,
                        const DistanceRequest<float>& request, DistanceResult<float>& result);

}  // namespace fcl
