// SPDX-License-Identifier: BSD-3-Clause
// The compiled part of the package `spherule`. Only its __init__.py imports it.

#include "base/error.h"
#include "python/bindings/support.h"

#include <exception>
#include <string>

namespace spherule::python {
namespace {

// Names of files in it need not be UTF-8.
py::str message_of(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace"));
}

// spherule.Error takes the two parts of what an Error says.
void translate(std::exception_ptr exception) {
  try {
    if (exception) std::rethrow_exception(exception);
  } catch (const Error& error) {
    const py::object type = result_class("Error");
    const py::tuple parts = py::make_tuple(message_of(error.subject()), message_of(error.reason()));
    PyErr_SetObject(type.ptr(), parts.ptr());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::options options;
  options.disable_function_signatures();
  py::register_exception_translator(translate);
  bind_pose(module);
  bind_mesh(module);
  bind_tree(module);
  bind_sphere_files(module);
  bind_solids(module);
  bind_queries(module);
  bind_sweep(module);
  bind_zones(module);
  bind_external(module);
  bind_simplify(module);
  bind_certify(module);
  bind_robot_model(module);
  bind_robot_files(module);
  bind_robot_formats(module);
  bind_robot_cover(module);
  bind_pairs(module);
  bind_scene(module);
  bind_checker(module);
}

}  // namespace spherule::python
