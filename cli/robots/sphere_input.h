// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/progress.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/srdf.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"

#include <set>
#include <span>
#include <string>
#include <vector>

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
