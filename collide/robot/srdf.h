// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/link_spheres.h"
#include "collide/robot/robot_model.h"

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

struct JointPosition {
  std::string joint;
  double position = 0.0;  // radians or metres
};

// A named configuration of a group.
struct GroupState {
  std::string name;
  std::string group;
  std::vector<JointPosition> positions{};
};

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

// Reads an SRDF file. Other elements (virtual and passive joints, properties, changes of defaults
// for collisions) are not read: none of them disables a pair that is not listed here as disabled.
//
// Throws Error, whose subject is the file and whose reason names the element and its line: for a
// file that cannot be read or is no SRDF, a missing or empty name, a number that is malformed or
// not finite, a radius below zero, a pair of a link with itself, two groups, end effectors or
// sphere approximations of the same name, a group within itself, and a group that does not exist.
SemanticDescription read_srdf(const std::filesystem::path& path);

// What the description names and the robot has not got, a line each ("group arm: there is no joint
// elbow"); empty if they fit. Files for a robot with and without its hand name more than there is,
// so that it is for the caller to say whether this is an error.
std::vector<std::string> unknown_names(const SemanticDescription& semantics,
                                       const RobotModel& robot);

}  // namespace spherule
