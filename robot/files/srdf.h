// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Semantic robot descriptions (SRDF).
//
// @code{.cpp}
// #include <spherule/robot/files/srdf.h>
// #include <spherule/base/files.h>
// #include <cassert>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.srdf";
// spherule::write_file_atomically(path, R"(<robot name="arm">
//   <disable_collisions link1="base" link2="hand" reason="Never"/>
// </robot>)");
// const spherule::SemanticDescription semantics = spherule::read_srdf(path);
// assert(semantics.disabled_pairs[0].reason == "Never");
// assert(!spherule::unknown_names(semantics, spherule::RobotModel("base")).empty());  // no hand
// @endcode

#include "robot/model/link_spheres.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {

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
