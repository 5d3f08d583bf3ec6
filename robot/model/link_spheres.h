// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "spheretree/sphere.h"

#include <span>
#include <string>
#include <vector>

namespace spherule {

// The spheres of one link, in the frame of the link, in metres.
struct LinkSpheres {
  std::string link;
  std::vector<Sphere> spheres;
};

// The robot with a sphere tree on every link that has spheres: what RobotScene takes. Throws Error
// for spheres of a link that the robot does not have, or that build_tree() refuses.
RobotModel with_spheres(RobotModel robot, std::span<const LinkSpheres> spheres);

}  // namespace spherule
