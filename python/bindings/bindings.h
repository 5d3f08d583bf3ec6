// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace spherule::python {

// Each adds what its source binds.
void bind_pose(pybind11::module_& module);
void bind_mesh(pybind11::module_& module);
void bind_tree(pybind11::module_& module);
void bind_sphere_files(pybind11::module_& module);
void bind_solids(pybind11::module_& module);
void bind_queries(pybind11::module_& module);
void bind_sweep(pybind11::module_& module);
void bind_zones(pybind11::module_& module);
void bind_external(pybind11::module_& module);
void bind_simplify(pybind11::module_& module);
void bind_certify(pybind11::module_& module);
void bind_robot_model(pybind11::module_& module);
void bind_robot_files(pybind11::module_& module);
void bind_robot_formats(pybind11::module_& module);
void bind_robot_cover(pybind11::module_& module);
void bind_pairs(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_checker(pybind11::module_& module);

}  // namespace spherule::python
