// SPDX-License-Identifier: BSD-3-Clause
#include "collide/collide.h"

#include "collide/search/box_gap.h"
#include "collide/search/queries.h"
#include "collide/search/sphere_leaves.h"

namespace spherule {

bool collides(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
              const Pose& world_from_b) noexcept {
  if (internal::far_apart(a, world_from_a, b, world_from_b)) return false;
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  if (internal::boxes_apart(a, b, pose)) return false;
  return internal::any_pair(a, b, pose, internal::SphereLeaves(a, b, pose));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  return internal::all_pairs(a, b, pose, internal::SphereLeaves(a, b, pose), request);
}

bool spheres_touch(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                   const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b) noexcept {
  return internal::RelativePose(a, world_from_a, b, world_from_b)
      .touches(a.spheres()[static_cast<std::size_t>(sphere_a)],
               b.spheres()[static_cast<std::size_t>(sphere_b)]);
}

double collision_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                       const Pose& world_from_b) noexcept {
  return internal::RelativePose(a, world_from_a, b, world_from_b).slack();
}

}  // namespace spherule
