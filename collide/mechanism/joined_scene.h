// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism/mechanism_kernel.h"
#include "collide/mechanism_check.h"
#include "spheretree/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Where a sphere of a joined set comes from.
struct SphereOrigin {
  int part = 0;  // a body or an obstacle
  std::int32_t sphere = 0;
};

// The spheres of bodies on one frame, in that frame, or of obstacles, in the root's.
struct JoinedSpheres {
  int frame = -1;
  std::vector<Sphere> spheres{};
  std::vector<SphereOrigin> origins{};
};

// Bodies and obstacles that are searched together: obstacles that meet the same bodies, and bodies
// on one frame that meet the same obstacles. Only those that are in a pair are here, and the pairs
// stand in the order in which they, or what they are joined with, are first named.
struct JoinedScene {
  std::vector<JoinedSpheres> bodies;
  std::vector<JoinedSpheres> obstacles;
  std::vector<KernelPair> pairs;

  JoinedScene(std::span<const MechanismBody> all_bodies,
              std::span<const MechanismObstacle> all_obstacles,
              std::span<const MechanismPair> all_pairs);
};

}  // namespace spherule::internal
