// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/robots.h"
#include "robot/formats/sphere_formats.h"
#include "spheretree/error.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

// What has no such attribute has the default.
template <class Value>
Value attribute(const py::object& object, const char* name, Value otherwise) {
  return py::hasattr(object, name) ? object.attr(name).cast<Value>() : otherwise;
}

py::object read_spheres(const py::object& path, const std::string& link,
                        const std::optional<std::size_t>& level) {
  const SphereFormatFile file =
      read_robot_spheres(path_of(path, "path"), {.link = link, .level = level});
  return robot_spheres_object(file.spheres, name_of(file.format));
}

RobotSpheres robot_spheres_of(const py::object& spheres) {
  using Buffers = std::map<std::string, double>;
  RobotSpheres result;
  result.links = link_spheres_of(spheres);
  result.robot = attribute<std::string>(spheres, "robot", "");
  if (py::hasattr(spheres, "self_collision_ignore")) {
    result.self_collision_ignore = pairs_of(spheres.attr("self_collision_ignore"));
  }
  result.self_collision_buffer = attribute<Buffers>(spheres, "self_collision_buffer", {});
  result.collision_buffer = attribute(spheres, "collision_buffer", 0.0);
  result.collision_buffers = attribute<Buffers>(spheres, "collision_buffers", {});
  result.interrupted = attribute(spheres, "interrupted", false);
  return result;
}

void write_spheres(const py::object& spheres, const std::string& format, const py::object& path,
                   const py::object& urdf, const py::object& original, const std::string& base_link,
                   const std::string& tool_link, const std::vector<std::string>& joint_names,
                   const std::vector<double>& joint_positions) {
  const auto kind = sphere_format_named(format);
  if (!kind)
    throw Error("format", "\"" + format + "\" is none of urdf, srdf, curobo, xrdf, foam, json");
  SphereFileContext context;
  if (!urdf.is_none()) context.urdf = path_of(urdf, "urdf");
  if (!original.is_none()) context.original = path_of(original, "original");
  context.base_link = base_link;
  context.tool_link = tool_link;
  context.joint_names = joint_names;
  context.joint_positions = joint_positions;
  write_robot_spheres(robot_spheres_of(spheres), *kind, context, path_of(path, "path"));
}

}  // namespace

std::vector<LinkSpheres> link_spheres_of(const py::object& given) {
  const py::object all = py::hasattr(given, "links") ? py::object(given.attr("links")) : given;
  if (!py::isinstance<py::dict>(all)) {
    throw py::type_error("spheres: it is neither a dict of arrays by link nor RobotSpheres");
  }
  std::vector<LinkSpheres> result;
  for (const auto& [name, array] : py::dict(all)) {
    const std::string link = py::str(name);
    const std::string argument = "spheres of " + link;
    result.push_back({.link = link, .spheres = spheres(array, argument.c_str()).copy()});
  }
  return result;
}

py::dict spheres_object(std::span<const LinkSpheres> all) {
  py::dict result;
  for (const LinkSpheres& link : all) {
    result[py::str(link.link)] = array_of(std::vector<Sphere>(link.spheres));
  }
  return result;
}

py::object robot_spheres_object(const RobotSpheres& spheres, std::string_view format) {
  return make_result("RobotSpheres", spheres_object(spheres.links), spheres.robot,
                     pairs_object(spheres.self_collision_ignore),
                     py::cast(spheres.self_collision_buffer), spheres.collision_buffer,
                     py::cast(spheres.collision_buffers), spheres.switched_off,
                     spheres.other_shapes, std::string(format), spheres.interrupted);
}

void bind_robot_formats(py::module_& module) {
  module.def(
      "read_robot_spheres", &read_spheres, py::arg("path"), py::kw_only(), py::arg("link") = "",
      py::arg("level") = py::none(),
      Help("read_robot_spheres(path, *, link='', level=None)",
           "Reads the spheres of a robot from spherized URDF, SRDF, cuRobo yml, XRDF, foam, "
           "MorphIt, ballpark, Bradshaw's .sph and our own files, told apart by what they "
           "hold: a RobotSpheres. `link` is that of formats of one mesh, `level` one of formats "
           "with levels, 0 the coarsest.")
          .c_str());
  module.def(
      "write_robot_spheres", &write_spheres, py::arg("spheres"), py::arg("format"), py::arg("path"),
      py::kw_only(), py::arg("urdf") = py::none(), py::arg("original") = py::none(),
      py::arg("base_link") = "", py::arg("tool_link") = "", py::arg("joint_names") = py::tuple(),
      py::arg("joint_positions") = py::tuple(),
      Help("write_robot_spheres(spheres, format, path, *, urdf=None, original=None, "
           "base_link='', tool_link='', joint_names=(), joint_positions=())",
           "Writes a file of format 'urdf', 'srdf', 'curobo', 'xrdf', 'foam' or 'json'. "
           "`spheres` is RobotSpheres, or a dict of arrays by link. `urdf` is the robot's own, "
           "`original` a file of the format that is kept but for the spheres.")
          .c_str());
}

}  // namespace spherule::python
