// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Robots from URDF files.
//
// @code{.cpp}
// #include <spherule/robot/files/urdf.h>
// #include <spherule/base/files.h>
// #include <cassert>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.urdf";
// spherule::write_file_atomically(path, R"(<robot name="post">
//   <link name="base"><collision><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
//   <link name="arm"/>
//   <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
// </robot>)");
// const spherule::RobotDescription robot = spherule::read_urdf(path);
// assert(robot.model.variable_count() == 1 && robot.links[0].collision.size() == 1);
// @endcode

#include "robot/model/robot_model.h"

#include <filesystem>
#include <map>
#include <string>

namespace spherule {

// Where a URDF finds its files.
struct UrdfOptions {
  // Roots of packages: package://NAME/REST is the file REST below packages[NAME]; slashes before
  // NAME mean nothing (package:///NAME/REST). A package that is not given is searched for upwards
  // from the URDF file: a folder with a package.xml of that name, or in such a folder one that is
  // called as the package and has one; then in the folders of ROS_PACKAGE_PATH, and in share/ below
  // those of AMENT_PREFIX_PATH; then a folder above the file, or in one of these, that is just
  // called so and has no package.xml of another name.
  std::map<std::string, std::filesystem::path> packages{};
  // Whether a mesh that is missing is an error. Otherwise its path is what the file names.
  bool require_visual_meshes = true;
  bool require_collision_meshes = true;
};

// Reads a robot from a URDF file (versions 1.0 to 1.2): joints, mimics, and the visual and
// collision shapes of every link: meshes, boxes, cylinders, capsules (their `length` is that of the
// straight part) and spheres. Lengths in metres, angles in radians. Links and joints come depth
// first: a link, then for each joint below it, in the order of the file, what hangs on it.
// Inertias, materials and whatever else the file holds are not examined.
//
// A planar joint NAME becomes three, with links of these names between them: prismatic ones, NAME/x
// and NAME/y, in the plane across its axis, and a continuous one about it, NAME/theta. A floating
// one becomes six, NAME/x, NAME/y, NAME/z, NAME/yaw, NAME/pitch and NAME/roll. Their lengths are
// limited to 100 m.
//
// Where the limits of a revolute or prismatic joint are missing or reversed, there is a warning,
// and it has none that are known.
//
// A file whose name ends in .xacro is given to the program `xacro`, without arguments, and what
// that writes is read in its place; lines that errors name are then lines of that.
//
// Mesh files are named package://PACKAGE/..., file://..., or by a path from the URDF file's folder;
// they must exist, as far as the options require it, and are not read. Where there is no file that
// is called as what follows package://PACKAGE/ or file://, it is one that this escapes as URLs do
// (%20). An axis that is not given is (1, 0, 0), and a limit 0. Of a fixed joint, axis, limits and
// mimic mean nothing. A size of zero (a point of contact, a flat box) is read as 1e-6, so that what
// is read holds the shape; visual boxes and spheres that are points are left out. In <geometry>,
// <material> and elements with a prefix are not examined.
//
// Throws Error, whose subject is the file and whose reason names the line where there is one: for a
// file that cannot be read, is no URDF, needs xacro (under another name), or is one for xacro where
// that fails or is not found; a number that is malformed or not finite, and attributes beside those
// that give a pose, an axis, a mimic or a shape; two origins or shapes where one belongs, other
// shapes, and negative sizes; a moving joint whose axis is zero, mimics of what does not move, is
// planar or floating, or of themselves; versions after 1.2; names
// that are not unique, a link below two joints or above itself, none or several roots; and missing
// meshes and packages.
RobotDescription read_urdf(const std::filesystem::path& path, const UrdfOptions& options = {});

}  // namespace spherule
