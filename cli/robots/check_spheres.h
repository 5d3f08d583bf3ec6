// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/robot_spheres.h"
#include "robot/files/srdf.h"
#include "robot/model/robot_model.h"

#include <string>
#include <vector>

namespace spherule {

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

}  // namespace spherule
