// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A robot, its spheres and a scene file become what answers queries.
//
// @code{.cpp}
// #include <spherule/robot/check/scene_setup.h>
// #include <cassert>
//
// const std::vector<spherule::LinkSpheres> spheres{
//     {.link = "base", .spheres = {{{0, 0, 1}, 0.1}}}};
// const auto robot = spherule::with_spheres(spherule::RobotModel("base"), spheres);
// spherule::SceneDescription cell;  // as read_scene() reads it
// cell.obstacles = {{.name = "floor", .shape = spherule::Primitive(spherule::HalfSpace{})}};
// const spherule::PreparedScene prepared = spherule::prepare_scene(robot, cell);
// const spherule::RobotChecker checker = prepared.scene.snapshot();
// spherule::RobotChecker::Scratch scratch(checker);
// assert(prepared.warnings.empty() && checker.check_config({}, scratch));
// @endcode

#include "geometry/sphere.h"
#include "robot/check/robot_scene.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/scene_file.h"
#include "robot/files/srdf.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// What stands for a cloud of points: spheres of which one contains the sphere of the source's
// radius about each point as it is written in the file, scaled exactly; with cells one for those of
// a cell. Throws Error as read_point_cloud() and point_cloud_spheres().
std::vector<Sphere> point_spheres(const PointsSource& source);

// A scene, and what a person should know of it.
struct PreparedScene {
  RobotScene scene;
  // Meshes that are open, and so are surfaces without an inside; attached meshes whose spheres
  // protrude by more than was requested.
  std::vector<std::string> warnings;
};

// Reads the files that a scene names and puts everything in its place. `robot` carries its spheres.
//
// Obstacles: a mesh becomes a SolidMesh, grown by what reading and scaling it cost; points become
// spheres grown by the same. Attached meshes are covered with spheres by cover_robot(), with their
// own max error or else that of `cover`, and proved to be covered. Of the pairs that the SRDF
// disables those of other robots' links are passed over.
//
// Throws Error naming the file, or what in the scene is of no use: as the readers, link_mesh(),
// cover_robot(), point_cloud_tree() and RobotScene do, for an attached mesh of which the
// spheres are not proved to cover all, and where the trees, clouds and meshes that come from a file
// that was named before have more than 2^22 nodes in all.
PreparedScene prepare_scene(RobotModel robot, const SceneDescription& scene,
                            const RobotCoverOptions& cover = {});

// Throws the Error that prepare_scene() would throw for a name that is unknown or taken and for a
// file that cannot be read or is malformed; of meshes, that no solid comes of them is not found. To
// be called before long work: reads all files. `robot` needs no spheres.
void check_scene_names(RobotModel robot, const SceneDescription& scene);

}  // namespace spherule

// Named configurations of a robot, and what touches in them.
//
// @code{.cpp}
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
