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
#include <string>
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
