// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Named configurations of a robot, and what touches in them.
//
// @code{.cpp}
// #include <spherule/robot/check/named_postures.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kRevolute,
//                                .lower = 0.5, .upper = 1.0});
// assert(spherule::zero_posture(robot).configuration[0] == 0.5);  // the limit that is nearest to 0
// const spherule::NamedPosture rest = spherule::rest_posture(robot);
// assert(rest.configuration[0] == 0.75);
// const spherule::AllowedCollisions allowed(robot);
// assert(spherule::contacts_in({&rest, 1}, robot, {}, allowed, nullptr).empty());  // no spheres
// @endcode

#include "robot/files/srdf.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// A configuration of a robot that has a name.
struct NamedPosture {
  std::string name;
  std::vector<double> configuration{};
};

// Where all variables are zero, or the limit that is nearest to it.
NamedPosture zero_posture(const RobotModel& robot);

// Where each variable is zero, or, if that is beyond its limits or within a tenth of its range of
// one, in the middle between them.
NamedPosture rest_posture(const RobotModel& robot);

// The states of a semantic description's groups, "GROUP/STATE", the other joints as in
// zero_posture(). What is about joints that the robot has not got, that do not move or follow
// others, or about several numbers for one joint, is passed over.
std::vector<NamedPosture> group_postures(const RobotModel& robot,
                                         const SemanticDescription& semantics);

// Two links whose spheres touch in a posture.
struct PostureContact {
  std::string posture;
  std::string first;
  std::string second;
  double overlap_depth = 0.0;    // of the deepest two spheres, in metres
  bool do_meshes_touch = false;  // their bodies, insides counted
  bool is_proved_free = false;   // in a free box of the proofs
};

// What touches in postures, of the links that `allowed` does not allow to: by the spheres that the
// robot's links carry. `proofs` of the robot and its bodies, or null. Throws Error as RobotScene
// and forward_kinematics() do.
std::vector<PostureContact> contacts_in(std::span<const NamedPosture> postures,
                                        const RobotModel& robot, std::span<const LinkBody> bodies,
                                        const AllowedCollisions& allowed,
                                        std::shared_ptr<const LinkPairs> proofs);

}  // namespace spherule
