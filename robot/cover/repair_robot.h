// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Makes the spheres of a robot, of any origin, cover it.
//
// @code{.cpp}
// #include <spherule/robot/cover/repair_robot.h>
// #include <cassert>
//
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive bar = spherule::Box{.size = {0.01, 0.01, 0.1}};
// robot.links = {{.name = "base", .collision = {{.name = "bar", .geometry = bar}}}};
// const std::vector<spherule::LinkSpheres> small{
//     {.link = "base", .spheres = {{{0, 0, 0}, 0.05}}}};
// const auto repaired = spherule::repair_robot(robot, small, {.max_error = 0.06});
// assert(repaired.links[0].certificate.covered);  // the corners were out
// @endcode

#include "robot/cover/link_mesh.h"
#include "robot/model/link_spheres.h"
#include "robot/model/robot_description.h"
#include "simplifier/certificate.h"
#include "simplifier/repair.h"
#include "spheretree/progress.h"

#include <span>
#include <string>
#include <vector>

namespace spherule {

// How a robot's spheres are repaired.
struct RobotRepairOptions {
  LinkGeometry geometry = LinkGeometry::kCollision;
  // E: how far a sphere that is grown or added may protrude, metres; 0 chooses for each link, as
  // RepairOptions::max_error does.
  double max_error = 0.0;
  int threads = 0;
  Progress progress = {};  // the word on what is being done is a link's name
};

// The repair of one link's spheres.
struct LinkRepair {
  std::string link;
  Repair repair;  // its spheres are those of RobotRepair::spheres
  // Of these spheres, against the simplified solid that simplify() makes of the link's mesh for
  // RobotRepairOptions::max_error: D is 4 E, or more for a link that is very large for its E; where
  // max_error is 0, E is 1 % of the diagonal of the box of the mesh.
  Certificate certificate;
  // For a person: a D that was chosen larger than 4 E.
  std::vector<std::string> warnings = {};
};

// A robot's spheres, repaired.
struct RobotRepair {
  // Of all links of the input in their order, then of those that had none and needed some.
  std::vector<LinkSpheres> spheres;
  std::vector<LinkRepair> links;  // of the links with geometry, in the order of the description
};

// Makes the spheres of every link cover its mesh, by repair(): no sphere is moved or shrunk.
// Spheres of links without geometry stay as they are. Throws Error as repair(), as
// audit_robot() for the robot and its spheres, and for a link more than 10,000 times max_error
// across.
RobotRepair repair_robot(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                         const RobotRepairOptions& options = {});

}  // namespace spherule
