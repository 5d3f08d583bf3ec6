// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Certifies the spheres of a robot, of any origin, and makes them cover it.
//
// @code{.cpp}
// #include <spherule/robot/cover/audit_robot.h>
// #include <cassert>
//
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive bar = spherule::Box{.size = {0.01, 0.01, 0.1}};
// robot.links = {{.name = "base", .collision = {{.name = "bar", .geometry = bar}}}};
// const std::vector<spherule::LinkSpheres> small{
//     {.link = "base", .spheres = {{{0, 0, 0}, 0.05}}}};
// assert(!spherule::audit_robot(robot, small).links_covered);  // the corners are out
// @endcode

#include "base/progress.h"
#include "robot/cover/robot_spheres.h"
#include "robot/model/robot_model.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// How a robot's spheres are certified.
struct RobotAuditOptions {
  LinkGeometry geometry = LinkGeometry::kCollision;
  // Spheres that cover a simplified solid S with little to spare need not cover everything that
  // certify() cannot tell from |M|: it reaches the mesh to within some 1/256 of its diagonal. Where
  // it finds no leak and no proof, spheres are judged once more by S as cover_robot() makes it for
  // this E and D (0: chosen by the same rule, 4 E or more). S holds M and |M| whatever E and D are,
  // so that this is proof as well.
  double max_error = 0.01;
  double min_external_diameter = 0.0;
  // Configurations in which the robot is judged as a whole (radians and metres).
  std::vector<std::vector<double>> configurations = {};
  int threads = 0;         // 0: all
  Progress progress = {};  // the word on what is being done is a link's name
};

// What is proved of a link's spheres against its own mesh. Lengths in metres, in the link's frame.
struct LinkAudit {
  std::string link;
  std::size_t spheres = 0;
  // Of the mesh and its inside, as written in the mesh files, and of primitives as they are; of S
  // (see the options) if that is what is proved. A link of primitives alone is proved to be covered
  // where each lies in a single sphere, however little larger that is, unless one of these spheres
  // overlaps more than two others of them. The point of the deepest leak is within 0.5 mm of a
  // point of the link where that has curved primitives, of the link elsewhere. Absent for a link
  // without geometry.
  std::optional<Certificate> certificate = std::nullopt;
  // Share of the surface that no sphere holds, estimated from points spread evenly over it.
  double uncovered_share = 0.0;
  // For a person: an open mesh; a D that was chosen larger than 4 E, for the S that is proved to be
  // covered; that a link is more than 10,000 E across, so that S was not examined.
  std::vector<std::string> warnings = {};
};

// The deepest leak of the robot in a configuration, all spheres of all links counted. Lengths in
// metres.
struct ConfigurationAudit {
  Bounds uncovered_depth;    // over all links, of their meshes and insides
  std::string deepest_link;  // by the lower bound, else by the upper; empty if all are covered
  // A point of it that is no less deep than the lower bound, or where the link has curved
  // primitives one within 0.5 mm of such a point, in the frame of the root; absent unless that is
  // above 0.
  std::optional<Eigen::Vector3d> deepest_leak = std::nullopt;
};

// What is proved of a robot's spheres.
struct RobotAudit {
  std::vector<LinkAudit> links;  // of every link, in the order of the description
  std::vector<ConfigurationAudit> configurations;
  // Links that have spheres and are none of the robot's.
  std::vector<std::string> unknown_links;
  // Proved: the spheres of each link cover its mesh, and what is inside (G1).
  bool links_covered = false;
  // Proved: the same of all spheres and all meshes, in every one of the configurations.
  bool configurations_covered = false;
};

// Certifies the spheres of a robot, of any origin, against its own meshes: link by link, by
// certify(), and as a whole in configurations. There, a link may be covered by spheres of its
// neighbours; what the rounding of kinematics and poses can do is charged to the mesh and to the
// spheres, so that a cover that is proved holds for the exact mechanism. Spheres of links that the
// robot has not got count nowhere.
// Throws Error: as link_mesh() and forward_kinematics(), for an E or D out of range, for spheres
// that are not usable (naming the link), a link named twice, a robot without any such geometry, and
// a configuration that takes a joint's position, a mimic's too, beyond 100.
RobotAudit audit_robot(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                       const RobotAuditOptions& options = {});

// Makes the spheres of a robot, of any origin, cover it.
//
// @code{.cpp}
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive bar = spherule::Box{.size = {0.01, 0.01, 0.1}};
// robot.links = {{.name = "base", .collision = {{.name = "bar", .geometry = bar}}}};
// const std::vector<spherule::LinkSpheres> small{
//     {.link = "base", .spheres = {{{0, 0, 0}, 0.05}}}};
// const auto repaired = spherule::repair_robot(robot, small, {.max_error = 0.06});
// assert(repaired.links[0].certificate.covered);  // the corners were out
// @endcode

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
