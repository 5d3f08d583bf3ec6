// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Robots from URDF files, and what an SRDF says of them.
//
// @code{.cpp}
// #include <spherule/robot/files/robot_description.h>
// #include <cassert>
// #include <fstream>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.urdf";
// std::ofstream(path) << R"(<robot name="post">
//   <link name="base"><collision><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
//   <link name="arm"/>
//   <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
// </robot>)";
// const spherule::RobotDescription robot = spherule::read_urdf(path);
// assert(robot.model.variable_count() == 1 && robot.links[0].collision.size() == 1);
// @endcode

#include "robot/model/robot_model.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace spherule {

// Where a URDF finds its files.
struct UrdfOptions {
  // Roots of packages: package://NAME/REST is the file REST below packages[NAME]; slashes before
  // NAME mean nothing (package:///NAME/REST). A package that is not given is searched for upwards
  // from the URDF file: a folder with a package.xml of that name, or in such a folder one that is
  // called as the package and has one.
  std::map<std::string, std::filesystem::path> packages{};
  // Whether a mesh that is missing is an error. Otherwise its path is what the file names.
  bool require_visual_meshes = true;
  bool require_collision_meshes = true;
};

// Reads a robot from a URDF file (version 1.0): joints of the types fixed, revolute, continuous and
// prismatic, mimics, and the visual and collision shapes of every link: meshes, boxes, cylinders
// and spheres. Lengths in metres, angles in radians. Links and joints come depth first: a link,
// then for each joint below it, in the order of the file, what hangs on it. Inertias, materials and
// whatever else the file holds are not examined.
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
// shapes, and negative sizes; planar and floating joints, a moving joint whose axis is zero
// or whose limits are missing or reversed, mimics of what does not move or of themselves; names
// that are not unique, a link below two joints or above itself, none or several roots; and missing
// meshes and packages.
RobotDescription read_urdf(const std::filesystem::path& path, const UrdfOptions& options = {});

// Semantic robot descriptions (SRDF).
//
// @code{.cpp}
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.srdf";
// std::ofstream(path) << R"(<robot name="arm">
//   <disable_collisions link1="base" link2="hand" reason="Never"/>
// </robot>)";
// const spherule::SemanticDescription semantics = spherule::read_srdf(path);
// assert(semantics.disabled_pairs[0].reason == "Never");
// assert(!spherule::unknown_names(semantics, spherule::RobotModel("base")).empty());  // no hand
// @endcode

// All links and joints between two links, one of which is an ancestor of the other.
struct LinkChain {
  std::string base_link;
  std::string tip_link;
};

// A named set of joints: those listed, the parent joints of the links, those of the chains, and
// those of other groups.
struct JointGroup {
  std::string name;
  std::vector<std::string> links{};
  std::vector<std::string> joints{};
  std::vector<LinkChain> chains{};
  std::vector<std::string> subgroups{};
};

// Two links that are not tested against each other, and why: "Adjacent", "Never", "Default", ...
struct DisabledPair {
  std::string link_a;
  std::string link_b;
  std::string reason;  // empty if the file gives none
};

// Radians or metres; several numbers for a planar or floating joint to the world.
struct JointState {
  std::string joint;
  std::vector<double> position;
};

// A named configuration of a group.
struct GroupState {
  std::string name;
  std::string group;
  std::vector<JointState> joints{};
};

// A tool of the robot.
struct EndEffector {
  std::string name;
  std::string group;
  std::string parent_link;
  std::string parent_group;  // empty if the file gives none
};

// What a semantic robot description (SRDF, of MoveIt) says of a robot, in the file's order.
struct SemanticDescription {
  std::string robot_name;
  std::vector<JointGroup> groups{};
  std::vector<GroupState> group_states{};
  std::vector<EndEffector> end_effectors{};
  std::vector<DisabledPair> disabled_pairs{};
  std::vector<LinkSpheres> sphere_approximations{};  // in the link's frame, metres
};

// Reads an SRDF file. Spheres of radius zero stand for none and are left out. Other elements
// (virtual and passive joints, properties, defaults for collisions and exceptions from them) are
// not read: without them no pair is disabled that is not listed here.
//
// Throws Error, whose subject is the file and whose reason names the line and the element: for a
// file that cannot be read or is no SRDF, a name that is missing, a number that is malformed or not
// finite, a radius below zero, a pair of a link with itself, a group that is not there or contains
// itself, and two groups, states of a group, end effectors or sphere approximations of one name.
SemanticDescription read_srdf(const std::filesystem::path& path);

// At most so many lines of unknown_names(): a long name of a group would stand in many.
inline constexpr std::size_t kMostUnknownNames = 1000;

// What the description names and the robot has not got, a line each ("group arm: there is no joint
// elbow"), the first of them; empty if they fit. Files for a robot with and without its hand name
// more than there is, so that it is for the caller to say whether this is an error.
std::vector<std::string> unknown_names(const SemanticDescription& semantics,
                                       const RobotModel& robot);

}  // namespace spherule
