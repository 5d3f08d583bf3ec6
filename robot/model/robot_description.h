// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A robot as a file describes it: its mechanism, and the shapes of its links.
//
// @code{.cpp}
// #include <spherule/robot/model/robot_description.h>
// #include <cassert>
//
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 1.0}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// assert(robot.links.size() == robot.model.links().size());
// @endcode

#include "collide/primitive.h"
#include "robot/model/robot_model.h"
#include "spheretree/pose.h"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace spherule {

// A mesh in a file. Times `scale`, coordinate by coordinate, it is in metres: of formats that state
// a unit (DAE, 3MF, glTF) what is scaled is in metres before, of others the file's own numbers are.
// A negative factor mirrors.
struct MeshFile {
  std::filesystem::path path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

// A shape that is rigidly attached to a link.
struct LinkShape {
  std::string name;  // often empty
  Pose link_from_shape{};
  std::variant<MeshFile, Primitive> geometry;
};

// What a link looks like and what stands for it in collision checks, in metres.
struct LinkDescription {
  std::string name;
  std::vector<LinkShape> visual{};
  std::vector<LinkShape> collision{};
};

// A robot as a file describes it. No mesh is read and no tree is built yet: `model` has no trees.
struct RobotDescription {
  std::string name;
  RobotModel model;
  std::vector<LinkDescription> links{};  // in the order of model.links()
};

}  // namespace spherule
