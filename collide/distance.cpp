// SPDX-License-Identifier: BSD-3-Clause
#include "collide/distance.h"

#include "collide/search/pair_space.h"
#include "collide/search/sphere_leaves.h"

namespace spherule {

DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  const internal::SphereLeaves leaves(a, b, pose);
  const internal::PairSpace space(a, b, pose, leaves);
  return internal::NearestFirst(space, pose.gap_error(), request)
      .run(internal::NodePair(0, 0), pose.gap(a.sphere(0), b.sphere(0)));
}

}  // namespace spherule
