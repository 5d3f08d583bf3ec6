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
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  // Links of which no pair is tested (disable_default_collisions), and pairs that are tested all
  // the same (enable_collisions), those of neighbours, too; disabled_pairs decide where both do.
  std::vector<std::string> links_disabled_by_default{};
  std::vector<std::pair<std::string, std::string>> enabled_pairs{};
  std::vector<LinkSpheres> sphere_approximations{};  // in the link's frame, metres
  std::vector<std::string> warnings{};               // what was not read, with its line
};

// Reads an SRDF file by the meaning that MoveIt (srdfdom) gives to it. Spheres of radius
// zero stand for none and are left out. Virtual and passive joints and properties of joints say
// nothing of what is here and are not examined; of each kind of other elements there is a warning.
// A file whose name ends in .xacro is given to the program `xacro`, as read_urdf() does.
//
// Throws Error, whose subject is the file and whose reason names the line and the element: for a
// file that cannot be read or is no SRDF, a name that is missing, a number that is malformed or not
// finite, a radius below zero, a pair of a link with itself, a group that is not there or contains
// itself, and two groups, states of a group, end effectors or sphere approximations of one name.
SemanticDescription read_srdf(const std::filesystem::path& path);

// The reason of pairs that are disabled by the default of one of their links.
inline constexpr std::string_view kDisabledByDefault = "disable_default_collisions";

// All pairs that the description disables: those of its list, then those of two of these links of
// which one is disabled by default, unless enabled_pairs has them.
std::vector<DisabledPair> disabled_among(const SemanticDescription& semantics,
                                         std::span<const std::string> links);

// The pairs that the description enables and does not disable.
std::vector<std::pair<std::string, std::string>> enabled_only(const SemanticDescription& semantics);

// At most so many lines of unknown_names(): a long name of a group would stand in many.
inline constexpr std::size_t kMostUnknownNames = 1000;

// What the description names and the robot has not got, a line each ("group arm: there is no joint
// elbow"), the first of them; empty if they fit. Files for a robot with and without its hand name
// more than there is, so that it is for the caller to say whether this is an error.
std::vector<std::string> unknown_names(const SemanticDescription& semantics,
                                       const RobotModel& robot);

}  // namespace spherule
