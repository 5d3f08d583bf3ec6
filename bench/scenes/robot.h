// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "robot/model/robot_model.h"

#include <array>

namespace spherule {

inline constexpr int kJoints = 6;
using ArmPositions = std::array<double, kJoints>;  // radians

// A six-axis industrial robot with the joint origins, axes and limits of the ABB IRB 4400L-30/2.43,
// in metres and radians: links base_link, link_1 .. link_6, without trees.
RobotModel make_robot();

// From link_6 to the mounting face of a tool; x points out of the flange.
Pose link6_from_flange();

// The links as solids in their frames, in the order of make_robot().links(), in metres: housings
// with ribs, flanges and screw holes as closed shells that overlap, of about the size of the real
// ones. 6,825 triangles in all, as the robot of the paper has.
std::array<TriangleMesh, kJoints + 1> make_robot_links();

}  // namespace spherule
