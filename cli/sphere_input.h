// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_spheres.h"
#include "collide/robot/sphere_formats.h"

#include <string>

namespace spherule {

// A robot's spheres from a file, as a command takes them.
struct SphereInput {
  SphereFormatFile file;
  bool names_links = true;  // the file does, itself
};

// As read_robot_spheres(). Spheres of one mesh are those of the only link with such geometry.
// Throws Error if more links have it.
SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options = {});

}  // namespace spherule
