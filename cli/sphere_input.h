// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_spheres.h"
#include "collide/robot/sphere_formats.h"

#include <string>

namespace spherule {

// What is wrong with spheres of one mesh where more than one link may be meant.
inline constexpr const char* kNameItsLink =
    "holds the spheres of one mesh: spherule audit-robot --link NAME --repair OUT writes them "
    "under "
    "the name of their link";

// A robot's spheres from a file, as a command that proves nothing by them alone takes them.
struct SphereInput {
  SphereFormatFile file;
  bool names_links = true;  // the file does, itself
};

// As read_robot_spheres(). Spheres of one mesh are those of the only link with such geometry.
// Throws Error if more links have it.
SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options = {});

}  // namespace spherule
