// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"

#include <memory>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace spherule::python {

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
