// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/pages/view_page.h"
#include "cli/robots/pair_report.h"
#include "cli/robots/trajectory.h"
#include "cli/text/json.h"
#include "geometry/pose.h"
#include "robot/cover/robot_spheres.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"

#include <string>
#include <vector>

namespace spherule {

// Whether a file tells of pairs of a robot's links and has no spheres: NAME.pairs, or an SRDF
// without approximations.
bool is_of_pairs_alone(const std::string& file);

// The pairs of links as the page takes them: indices of links, kind, verdict and, where they are
// proved free somewhere and not ignored, the boxes, a letter for each node ('A' a box that is not
// proved, 'B' a free one, from 'C' on one that is halved: its variable).
Json view_pairs(const PairKinds& kinds);

struct RobotViewOptions {
  std::vector<std::string> packages;  // NAME=DIR
  std::vector<std::string> geometry;  // names, the first is shown at first
  bool ignores_unknown_links = false;
  TrajectoryArguments postures{};  // no file: none
};

// A pose as the page takes it: x, y, z, and the quaternion, w last.
Json view_pose(const Pose& pose);

// The links and joints of a robot, and the meshes of its links in that geometry, of which `name`
// is the name. Spheres, which are those of a spherized URDF, are not among the meshes. Throws Error
// as link_mesh().
Json view_robot(const RobotDescription& robot);
ViewItem view_meshes(const RobotDescription& robot, LinkGeometry geometry, const std::string& name);

// A robot with the meshes of its links in a geometry, the spheres that were made or audited for it,
// called `name`, and the leaks that the certificates of its links tell of: what `robot` reports, or
// `audit-robot --json` prints. Throws Error as link_mesh().
ViewScene covered_robot_scene(const RobotDescription& robot, const std::string& geometry,
                              const RobotSpheres& spheres, const std::string& name,
                              const Json& report);

// Whether a file is of a robot: a URDF, its spheres in any format, what is known of the pairs of
// its links (NAME.pairs, SRDF), or a certificate by links.
// Meshes, and what view_items() knows otherwise, are not. Throws Error if it cannot be read.
bool is_robot_file(const std::string& file);

// Adds the robot of the first URDF among the files, its postures, the meshes of its links, and what
// the other files hold for them: spheres as trees, so that the page has levels of them, and leaks;
// of the first spheres also what is known of the pairs of links. What a report says of links that
// the robot has not is left out and counted. Throws Error, naming the file, for files without a
// URDF among them, for spheres of which none are of a link of the robot, and as
// require_known_links().
void add_robot(const std::vector<std::string>& files, const RobotViewOptions& options,
               ViewScene& scene);

}  // namespace spherule
