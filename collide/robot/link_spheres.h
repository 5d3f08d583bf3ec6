// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// The balls of one link, in the frame of the link, in metres.
struct LinkSpheres {
  std::string link;
  std::vector<Sphere> spheres;
};

// Two links whose overlap is not a collision.
struct IgnoredPair {
  std::string link1;
  std::string link2;
  std::string reason;  // SRDF has one ("Adjacent", "Never", ...); other formats do not
};

// The balls of a robot, and what the formats of other tools say beside them.
struct RobotSpheres {
  std::string robot;  // empty where the format names no robot
  std::vector<LinkSpheres>
      links;  // no name twice; one without spheres is a link stated to have none
  // Pairs left out of self-collision checks, no pair twice (cuRobo and XRDF: self-collision ignore;
  // SRDF: disable_collisions).
  std::vector<IgnoredPair> self_collision_ignore;
  // By how much the balls of a link are grown in self-collision checks, metres; cuRobo and XRDF
  // only.
  std::map<std::string, double> self_collision_buffer;
  // By how much all balls are grown in checks against the world, metres; cuRobo only, and absent
  // where each link has its own (collision_buffer).
  std::optional<double> collision_sphere_buffer;
  // The same for each link; cuRobo and XRDF only.
  std::map<std::string, double> collision_buffer;
  // Balls that the file switches off by a radius of zero or below; they are left out of `links`.
  std::size_t switched_off = 0;
};

}  // namespace spherule
