// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A robot with spheres on its links.
//
// @code{.cpp}
// #include <spherule/robot/model/link_spheres.h>
// #include <cassert>
//
// const std::vector<spherule::LinkSpheres> spheres{
//     {.link = "base", .spheres = {{{0, 0, 0}, 0.1}}}};
// const auto robot = spherule::with_spheres(spherule::RobotModel("base"), spheres);
// assert(robot.links()[0].trees[0]->spheres()[0].radius == 0.1);
// @endcode

#include "geometry/sphere.h"
#include "robot/model/robot_model.h"

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
