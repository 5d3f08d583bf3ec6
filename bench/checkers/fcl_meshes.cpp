// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_mesh_checker.h"

#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/collision_func_matrix.h>
#include <fcl/narrowphase/detail/distance_func_matrix.h>
#include <fcl/narrowphase/distance.h>

#include <cstddef>
#include <type_traits>

template class fcl::DynamicAABBTreeCollisionManager<float>;

namespace spherule {
namespace {

template <class Volume>
constexpr bool kInLibrary = std::is_same_v<typename Volume::S, double>;

}  // namespace

template <class Volume>
bool fcl_meshes_touch(const fcl::CollisionGeometry<typename Volume::S>& a,
                      const fcl::Transform3<typename Volume::S>& world_from_a,
                      const fcl::CollisionGeometry<typename Volume::S>& b,
                      const fcl::Transform3<typename Volume::S>& world_from_b) {
  const fcl::CollisionRequest<typename Volume::S> request;  // one contact, not kept
  fcl::CollisionResult<typename Volume::S> result;
  if constexpr (kInLibrary<Volume>) {
    return fcl::collide(&a, world_from_a, &b, world_from_b, request, result) > 0;
  } else {
    return fcl::detail::BVHCollide<Volume>(&a, world_from_a, &b, world_from_b, request, result) > 0;
  }
}

template <class Volume>
typename Volume::S fcl_mesh_distance(const fcl::CollisionGeometry<typename Volume::S>& a,
                                     const fcl::Transform3<typename Volume::S>& world_from_a,
                                     const fcl::CollisionGeometry<typename Volume::S>& b,
                                     const fcl::Transform3<typename Volume::S>& world_from_b) {
  const fcl::DistanceRequest<typename Volume::S> request;  // without the points
  fcl::DistanceResult<typename Volume::S> result;
  if constexpr (kInLibrary<Volume>) {
    return fcl::distance(&a, world_from_a, &b, world_from_b, request, result);
  } else {
    return fcl::detail::BVHDistance<Volume>(&a, world_from_a, &b, world_from_b, request, result);
  }
}

#define SPHERULE_QUERIES(Volume)                                                             \
  template bool fcl_meshes_touch<Volume>(                                                    \
      const fcl::CollisionGeometry<Volume::S>& a, const fcl::Transform3<Volume::S>& pose_a,  \
      const fcl::CollisionGeometry<Volume::S>& b, const fcl::Transform3<Volume::S>& pose_b); \
  template Volume::S fcl_mesh_distance<Volume>(                                              \
      const fcl::CollisionGeometry<Volume::S>& a, const fcl::Transform3<Volume::S>& pose_a,  \
      const fcl::CollisionGeometry<Volume::S>& b, const fcl::Transform3<Volume::S>& pose_b);
SPHERULE_QUERIES(fcl::OBB<double>)
SPHERULE_QUERIES(fcl::OBB<float>)
SPHERULE_QUERIES(fcl::OBBRSS<double>)
SPHERULE_QUERIES(fcl::OBBRSS<float>)
SPHERULE_QUERIES(fcl::RSS<double>)
#undef SPHERULE_QUERIES

}  // namespace spherule
