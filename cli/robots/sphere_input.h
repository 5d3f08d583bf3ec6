// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/robot_spheres.h"
#include "robot/formats/sphere_formats.h"

#include <string>

namespace CLI {
class App;
}

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

// Adds --ignore-unknown-links.
void add_unknown_links_flag(CLI::App& command, bool& ignores);

// Throws Error, naming the file and the links, if it has spheres of links that the robot has not
// got, unless these are to be ignored: then it warns of them. Throws Error in any case if no link
// of the robot has spheres there, but some other has.
void require_known_links(const RobotModel& robot, const std::string& file,
                         const RobotSpheres& spheres, bool ignores);

// Warns if the file names another geometry for self-collisions, which no command reads.
void warn_of_other_geometry(const std::string& file, const RobotSpheres& spheres);

// As read_robot_spheres(), with that warning. Spheres of one mesh are those of the only link with
// such geometry. Throws Error if none has it, or several.
SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options = {});

}  // namespace spherule
