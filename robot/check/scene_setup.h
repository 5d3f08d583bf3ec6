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
#include "robot/model/robot_model.h"

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
  // protrude by more than was requested; elements and links of the SRDF that are not known.
  std::vector<std::string> warnings;
};

// Reads the files that a scene names and puts everything in its place. `robot` carries its spheres.
//
// Obstacles: a mesh becomes a SolidMesh, grown by what reading and scaling it cost; points become
// spheres grown by the same. Attached meshes are covered with spheres by cover_robot(), with their
// own max error or else that of `cover`, and proved to be covered. The pairs of `ignored`, which a
// file of spheres may name, are allowed first; then the SRDF decides (AllowedCollisions::apply()).
//
// Throws Error naming the file, or what in the scene is of no use: as the readers, link_mesh(),
// cover_robot(), point_cloud_tree() and RobotScene do, for an attached mesh of which the
// spheres are not proved to cover all, and where the trees, clouds and meshes that come from a file
// that was named before have more than 2^22 nodes in all.
PreparedScene prepare_scene(RobotModel robot, const SceneDescription& scene,
                            const RobotCoverOptions& cover = {},
                            std::span<const DisabledPair> ignored = {});

// Throws the Error that prepare_scene() would throw for a name that is unknown or taken and for a
// file that cannot be read or is malformed; of meshes, that no solid comes of them is not found. To
// be called before long work: reads all files. `robot` needs no spheres.
void check_scene_names(RobotModel robot, const SceneDescription& scene);

}  // namespace spherule
