// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Does a placed robot overlap a single obstacle? For more, see RobotScene.
//
// @code{.cpp}
// #include <spherule/robot/check/robot_collision.h>
// #include <spherule/robot/model/kinematics.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{1, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.attach("base", sphere);
// std::vector<spherule::Pose> world_from_link;
// spherule::forward_kinematics(robot, {}, world_from_link);
// assert(robot_collides(robot, world_from_link, *sphere, {}));
// @endcode

#include "collide/collide.h"
#include "robot/model/robot_model.h"

#include <span>

namespace spherule {

// Whether a tree on any link overlaps a placed obstacle: collides() for each of them, the last link
// first, because the tool at the end of the chain is what usually touches. `world_from_link` as
// forward_kinematics() gives it, one pose for each link; the number is not checked. Links are not
// tested against each other. Of a robot or a tree that was moved from it ends the program.
bool robot_collides(const RobotModel& robot, std::span<const Pose> world_from_link,
                    const SphereTree& obstacle, const Pose& world_from_obstacle) noexcept;

}  // namespace spherule
