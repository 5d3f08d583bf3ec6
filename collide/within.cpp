// SPDX-License-Identifier: BSD-3-Clause
#include "collide/within.h"

#include "collide/search/queries.h"
#include "collide/search/sphere_leaves.h"
#include "spheretree/error.h"

namespace spherule {

void require_clearance(double clearance) {
  if (!(clearance >= 0.0 && clearance <= kMaxCoordinate)) {
    throw Error("clearance", "it is not a number from 0 to 1e15");
  }
}

bool within(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  if (internal::far_apart(a, world_from_a, b, world_from_b, clearance)) return false;
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  if (internal::boxes_apart(a, b, pose, clearance)) return false;
  return internal::any_pair_within(a, b, pose, internal::SphereLeaves(a, b, pose, clearance),
                                   clearance);
}

bool spheres_within(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                    const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b,
                    double clearance) {
  require_clearance(clearance);
  return internal::RelativePose(a, world_from_a, b, world_from_b)
      .touches(a.spheres()[static_cast<std::size_t>(sphere_a)],
               b.spheres()[static_cast<std::size_t>(sphere_b)], clearance);
}

double within_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                    const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return internal::RelativePose(a, world_from_a, b, world_from_b).slack(clearance);
}

}  // namespace spherule
