// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/robot_spheres.h"
#include "robot/formats/sphere_formats.h"

#include <string>

namespace spherule {

// What is wrong with spheres of one mesh where the link that is meant is not known.
inline constexpr const char* kNameItsLink =
    "holds the spheres of one mesh: spherule audit-robot --link NAME --repair OUT writes "
    "them under the name of their link";

// A robot's spheres from a file, for commands that show or prove where they are.
struct SphereInput {
  SphereFormatFile file;
  bool names_links = true;  // the file does, itself
};

// As read_robot_spheres(). Spheres of one mesh are those of the only link with such geometry.
// Throws Error if none has it, or several.
SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options = {});

}  // namespace spherule
