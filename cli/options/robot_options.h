// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/robot_spheres.h"
#include "robot/files/urdf.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// Adds --package, which may be given several times, to a command.
void add_package_option(CLI::App& command, std::vector<std::string>& packages);

// Adds --geometry, of which a command takes one, with what it means there.
void add_geometry_option(CLI::App& command, const std::string& description, std::string& geometry);

// Adds both to the words of another command, as they were given to this one.
void repeat_robot_options(const std::string& geometry, const std::vector<std::string>& packages,
                          std::vector<std::string>& words);

// The packages of texts NAME=DIR, and whose meshes are needed: those of these geometries. Throws
// Error for other texts and a name given twice.
UrdfOptions urdf_options(const std::vector<std::string>& packages,
                         std::span<const LinkGeometry> needed);

// Reads a robot of which a command uses that geometry: meshes of the other one may be missing.
// Throws Error as read_urdf(), and where no link has that geometry.
RobotDescription read_robot(const std::string& urdf, const std::vector<std::string>& packages,
                            LinkGeometry geometry);

// What --geometry takes, the default first, and what it names. Error for another name.
std::vector<std::string> geometry_names();
LinkGeometry geometry_named(const std::string& name);

// The options of links from texts NAME:max-error=E,min-external=D,padding=T,zones=FILE, of which
// any may be left out; E, D and T in metres, FILE as `fit --zones` reads it. Several texts for one
// link add up. Throws Error for a text that is not of this form, a value that is no number, one
// given twice, and as read_zones().
std::map<std::string, LinkCoverOptions> link_options(const std::vector<std::string>& texts);

// The files of zones that such texts name.
std::vector<std::filesystem::path> zone_files(const std::vector<std::string>& texts);

}  // namespace spherule
