// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What commands read of a robot: its description, options about it, and its spheres.

#include "cli/text/progress.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"

#include <filesystem>
#include <map>
#include <set>
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

// The packages of texts NAME=DIR, and whose meshes are needed: those of these geometries. Throws
// Error for other texts and a name given twice.
UrdfOptions urdf_options(const std::vector<std::string>& packages,
                         std::span<const LinkGeometry> needed);

// As read_urdf() with these options; prints the warnings.
RobotDescription read_urdf_with_warnings(const std::string& urdf,
                                         const std::vector<std::string>& packages,
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

// What a robot is made of for a check, and pairs of links that its spheres' file leaves out.
struct SphereRobot {
  RobotModel model;
  std::vector<DisabledPair> ignored;
  bool is_whole = true;  // every shape that was read stands in spheres
};

// The spheres of a file. Warns of what in it is not checked. Pairs of links that the robot has not
// got are passed over. Throws Error as read_robot_spheres() and require_known_links(), and for
// spheres of one mesh, whose link is not known.
SphereRobot read_sphere_robot(const std::string& file, const RobotDescription& robot,
                              LinkGeometry geometry, bool ignores_unknown_links);

// Those that cover the robot; `urdf` is what errors name. Throws Error as cover_robot(), and where
// a link is not proved to be covered.
SphereRobot cover_sphere_robot(const std::string& urdf, const RobotDescription& robot,
                               RobotCoverOptions options);

// The warnings about the links of a robot that is covered or audited, each once on standard error:
// doubts about sizes before the long work, in which a search for a goal covers links again and
// again, and the rest after it. What follows the figures in brackets, "open (8 edges): ...",
// explains them, and is printed for the first link of which the same is said.
class LinkWarnings {
 public:
  // For the field of that name in the options; refers to this and the bar.
  decltype(RobotCoverOptions::on_doubt) on_doubt(ProgressBar& bar);

  // Those of a link that were not printed before.
  void print(const std::string& link, std::span<const std::string> warnings);

 private:
  void print(const std::string& link, const std::string& warning);

  std::set<std::string> printed_;
  std::set<std::string> explained_;
};

}  // namespace spherule
