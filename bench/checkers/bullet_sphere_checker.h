// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"

#include <memory>

namespace spherule {

// The same spheres in Bullet (single precision, as Debian packages it): a btCompoundShape of
// btSphereShapes for each body and obstacle, its dynamic AABB tree rebuilt from the top down, which
// Bullet's own insertion one by one falls behind of, margins zero. Radii are padded by what
// rounding costs, so that no contact is missed.
enum class BulletQuery {
  // btCollisionWorld::contactPairTest for each pair whose boxes overlap: the interface that Bullet
  // offers. It finds all contacts of a pair: there is no way to stop it at the first.
  kContactPairTest,
  // The two compounds' trees, walked in the order and with the box test of Bullet's own algorithm
  // for compounds, with a plain test of two spheres at the leaves, until the first contact: faster
  // than what a user can have from Bullet.
  kTrees,
};

std::unique_ptr<Checker> make_bullet_sphere_checker(const Workload& workload, BulletQuery query);

}  // namespace spherule
