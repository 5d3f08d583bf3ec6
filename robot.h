// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Robots: read, covered with spheres that are proved to cover, put into a scene, and checked in
// configurations and on motions, which are proved free at every point. Metres and radians. Link
// spherule::robot.
//
// @code{.cpp}
// #include <spherule/robot.h>
// #include <cassert>
// #include <fstream>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_door.urdf";
// std::ofstream(path) << R"(<robot name="turner">
//   <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
//   <link name="arm"><collision><origin xyz="0.5 0 0"/>
//     <geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
//   <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
//     <axis xyz="0 0 1"/></joint></robot>)";
//
// const spherule::RobotDescription robot = spherule::read_urdf(path);
// const auto cover = spherule::cover_robot(robot, {.max_error = 0.05, .effort = 0});
// assert(spherule::links_not_proved(cover).empty());
// spherule::RobotScene scene(
//     spherule::with_spheres(robot.model, spherule::robot_spheres(robot, cover).links));
// scene.add("post", spherule::Primitive(spherule::Cylinder{0.1, 2.0}),
//           spherule::Pose::from_translation({0.0, 0.6, 0.0}));
// const spherule::RobotChecker checker = scene.snapshot();
// spherule::RobotChecker::Scratch scratch(checker);  // one for each thread
// assert(checker.check_config(std::vector{0.0}, scratch));
// const auto edge = checker.check_edge(std::vector{0.0}, std::vector{3.0}, scratch);
// assert(edge.verdict == spherule::Verdict::kCollision);  // the post is in between
// @endcode
//
// What is where, below robot/:
//   model/robot_model.h           RobotModel, RobotDescription, with_spheres()
//   model/kinematics.h            forward_kinematics() and its error bound, ShortestMotion
//   files/robot_description.h     read_urdf(), read_srdf()
//   files/scene_file.h            read_scene(), read_point_cloud()
//   files/trajectory_file.h       read_trajectory()
//   formats/sphere_formats.h      spheres in the formats of cuRobo, XRDF, SRDF, foam and others
//   cover/robot_spheres.h         cover_robot(): spheres for every link
//   cover/audit_robot.h           do given spheres cover the robot? repair_robot() makes them
//   pairs/allowed_collisions.h    the allowed collision matrix
//   pairs/link_pairs.h            prove_link_pairs(): links that never touch, or not everywhere
//   check/robot_scene.h           RobotScene: the robot and what is around it
//   check/robot_checker.h         RobotChecker: configurations, motions, clearances, contacts
//   check/scene_setup.h           prepare_scene(): a scene of a file
// Planners of OMPL: adapters/ompl/validators.h of spherule::ompl. What is proved:
// docs/guarantee.md.

#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/audit_robot.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "robot/files/scene_file.h"
#include "robot/files/trajectory_file.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"
