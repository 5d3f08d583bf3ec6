// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/pages/view_page.h"
#include "robot/files/scene_file.h"
#include "robot/model/robot_model.h"

#include <vector>

namespace spherule {

// What stands in a scene, in the world: meshes and primitives as triangles, points, spheres and
// trees as spheres, and what is attached to links of the robot, in their frames. Of a half-space,
// a square of its surface about the other obstacles. Parts have the names of the scene. Throws
// Error as link_mesh() and the readers do.
std::vector<ViewItem> view_obstacles(const SceneDescription& scene, const RobotModel& robot);

}  // namespace spherule
