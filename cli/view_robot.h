// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/view_page.h"

#include <string>
#include <vector>

namespace spherule {

struct RobotViewOptions {
  std::vector<std::string> packages;  // NAME=DIR
  std::vector<std::string> geometry;  // names, the first is shown at first
  bool ignores_unknown_links = false;
};

// Whether a file is of a robot: a URDF, its spheres in any format, what is known of the pairs of
// its links (NAME.pairs, SRDF), or a certificate by links.
// Meshes, and what view_items() knows otherwise, are not. Throws Error if it cannot be read.
bool is_robot_file(const std::string& file);

// Adds the robot of the first URDF among the files, the meshes of its links, and what the other
// files hold for them: spheres as trees, so that the page has levels of them, and leaks; of the
// first spheres also what is known of the pairs of links. What a report says of links that the
// robot has not is left out and counted. Throws Error, naming the file, for files without a URDF
// among them, for spheres of which none are of a link of the robot, and as require_known_links().
void add_robot(const std::vector<std::string>& files, const RobotViewOptions& options,
               ViewScene& scene);

}  // namespace spherule
