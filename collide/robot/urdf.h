// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_description.h"

#include <filesystem>
#include <map>
#include <string>

namespace spherule {

struct UrdfOptions {
  // Roots of packages: package://NAME/REST is the file REST below packages[NAME]. A package that is
  // not given is looked for upwards from the URDF file: a folder with a package.xml of that name.
  std::map<std::string, std::filesystem::path> packages{};
};

// Reads a robot from a URDF file (as urdfdom does, more strictly): joints of the types fixed,
// revolute, continuous and prismatic, mimics, and the visual and collision shapes of every link:
// meshes, boxes, cylinders, spheres and, where urdfdom knows them, capsules. Lengths in metres,
// angles in radians. Links come in the order of the file as far as a parent can come before its
// children, joints in the order of their child links.
//
// Mesh files are named package://PACKAGE/..., file://..., or by a path from the URDF file's folder;
// they must exist, and are not read. An axis that is not given is (1, 0, 0); a fixed joint needs
// none.
//
// Throws Error, whose subject is the file and whose reason names the link or joint: for a file that
// cannot be read or is no URDF, a number that is malformed or not finite, planar and floating
// joints, a moving joint whose axis is zero, reversed limits, mimics of nothing or of themselves, a
// link with two parents, several roots, shapes without extent, and missing meshes and packages.
RobotDescription read_urdf(const std::filesystem::path& path, const UrdfOptions& options = {});

}  // namespace spherule
