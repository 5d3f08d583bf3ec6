// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"

#include <bullet/BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <bullet/btBulletCollisionCommon.h>

namespace spherule {

inline btVector3 bullet_vector(const Eigen::Vector3d& v) {
  const Eigen::Matrix<btScalar, 3, 1> rounded = v.cast<btScalar>();
  return {rounded.x(), rounded.y(), rounded.z()};
}

inline btTransform bullet_pose(const Pose& pose) {
  const Eigen::Matrix<btScalar, 3, 3> r = pose.matrix().cast<btScalar>();
  const btMatrix3x3 rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                             r(2, 2));
  return btTransform(rotation, bullet_vector(pose.translation()));
}

// Whether two objects touch, by btCollisionWorld::contactPairTest: the interface that Bullet
// offers. Shapes of GImpact are known to it.
class BulletPairTest {
 public:
  BulletPairTest() {
    // As btGImpactCollisionAlgorithm::registerAlgorithm(), which forgets the table that
    // contactPairTest examines.
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
      dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, type, &gimpact_);
      dispatcher_.registerClosestPointsCreateFunc(type, GIMPACT_SHAPE_PROXYTYPE, &swapped_gimpact_);
    }
    swapped_gimpact_.m_swapped = true;
  }

  bool operator()(btCollisionObject& a, btCollisionObject& b) {
    Contacts contacts;
    world_.contactPairTest(&a, &b, contacts);
    return contacts.found();
  }

 private:
  class Contacts : public btCollisionWorld::ContactResultCallback {
   public:
    // A pair that Bullet passes on has a distance of at most its threshold, which may be above 0.
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      found_ |= point.getDistance() <= 0;
      return 0;
    }
    bool found() const { return found_; }

   private:
    bool found_ = false;
  };

  static btDefaultCollisionConstructionInfo sizes() {
    btDefaultCollisionConstructionInfo info;
    info.m_customCollisionAlgorithmMaxElementSize = sizeof(btGImpactCollisionAlgorithm);
    return info;
  }

  btDefaultCollisionConfiguration configuration_{sizes()};
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
  btGImpactCollisionAlgorithm::CreateFunc gimpact_;
  btGImpactCollisionAlgorithm::CreateFunc swapped_gimpact_;
};

}  // namespace spherule
