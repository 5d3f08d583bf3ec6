// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Robots and what belongs to them as the package has them, and back.

#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <memory>
#include <pybind11/pybind11.h>
#include <span>
#include <string>
#include <vector>

namespace spherule::python {

namespace py = pybind11;

// Python's classes hold pointers to what is not const, though nothing changes it.
template <class Kept>
std::shared_ptr<Kept> unconst(const std::shared_ptr<const Kept>& kept) {
  return std::const_pointer_cast<Kept>(kept);
}

// A RobotModel, or that of a RobotDescription.
const RobotModel& model_of(py::handle robot);
// TypeError for what is none.
std::shared_ptr<const RobotDescription> description_of(py::handle robot);

// A dict of arrays by link, or what has one as `links` (RobotSpheres); and the dict.
std::vector<LinkSpheres> link_spheres_of(const py::object& spheres);
py::dict spheres_object(std::span<const LinkSpheres> spheres);
py::object robot_spheres_object(const RobotSpheres& spheres, std::string_view format);

py::tuple pairs_object(std::span<const DisabledPair> pairs);
std::vector<DisabledPair> pairs_of(const py::object& pairs);

LinkGeometry geometry_of(py::handle geometry);

// AllowedCollisions, and the robot that they were made for.
struct AllowedOfRobot {
  RobotModel robot;
  AllowedCollisions allowed;
};

std::string_view word_of(AllowedReason reason);

// All that was put into a scene, and a scene of it.
pybind11::tuple scene_state(const RobotScene& scene);
std::shared_ptr<RobotScene> scene_from(const pybind11::tuple& state);

// A SphereTree, SolidMesh or primitive; a TriangleMesh, or what mesh_of() takes, becomes a
// SolidMesh.
ObstacleShape obstacle_of(pybind11::handle shape);

// A checker, what it was made of, and scratches that no query uses now. The list is only touched
// under the interpreter's lock.
struct CheckerOfScene {
  RobotScene scene;
  pybind11::tuple options;
  RobotChecker checker;
  std::size_t dof;
  std::vector<RobotChecker::Scratch> idle{};
};

std::shared_ptr<CheckerOfScene> snapshot(const RobotScene& scene, bool enforce_limits,
                                         const pybind11::object& instructions,
                                         const pybind11::object& meshes);

}  // namespace spherule::python
