// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"

#include <memory>
#include <pybind11/pybind11.h>

namespace spherule::python {

// All that was put into a scene, and a scene of it.
pybind11::tuple scene_state(const RobotScene& scene);
std::shared_ptr<RobotScene> scene_from(const pybind11::tuple& state);

// A SphereTree, SolidMesh or primitive; a TriangleMesh, or what mesh_of() takes, becomes a
// SolidMesh.
ObstacleShape obstacle_of(pybind11::handle shape);

}  // namespace spherule::python
