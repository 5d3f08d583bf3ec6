// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/zones.h"

#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "simplifier/concave_edges.h"
#include "simplifier/zone_file.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

py::tuple triple(const Eigen::Vector3d& point) {
  return py::make_tuple(point.x(), point.y(), point.z());
}

std::optional<double> number_or_none(py::handle object, const char* attribute) {
  if (object.attr(attribute).is_none()) return std::nullopt;
  return number_of(object, attribute);
}

ZoneShape zone_shape_of(const py::object& shape) {
  const py::handle type = py::type::handle_of(shape);
  if (type.is(result_class("ZoneSphere"))) {
    return Sphere{vector3(shape.attr("center"), "center"), number_of(shape, "radius")};
  }
  if (type.is(result_class("ZoneBox"))) {
    return Eigen::AlignedBox3d(vector3(shape.attr("min"), "min"),
                               vector3(shape.attr("max"), "max"));
  }
  if (type.is(result_class("ZoneCapsule"))) {
    return ZoneCapsule{vector3(shape.attr("start"), "start"), vector3(shape.attr("end"), "end"),
                       number_of(shape, "radius")};
  }
  throw py::type_error("zones: the shape is no ZoneSphere, ZoneBox or ZoneCapsule");
}

py::object zone_shape_object(const ZoneShape& shape) {
  if (const auto* ball = std::get_if<Sphere>(&shape)) {
    return make_result("ZoneSphere", triple(ball->center), ball->radius);
  }
  if (const auto* box = std::get_if<Eigen::AlignedBox3d>(&shape)) {
    return make_result("ZoneBox", triple(box->min()), triple(box->max()));
  }
  const auto& capsule = std::get<ZoneCapsule>(shape);
  return make_result("ZoneCapsule", triple(capsule.from), triple(capsule.to), capsule.radius);
}

}  // namespace

std::vector<Zone> zones_of(const py::object& zones) {
  std::vector<Zone> result;
  for (const py::handle zone : zones) {
    if (!py::type::handle_of(zone).is(result_class("Zone"))) {
      throw py::type_error("zones: an element is no Zone");
    }
    result.push_back({.shape = zone_shape_of(zone.attr("shape")),
                      .max_error = number_or_none(zone, "max_error"),
                      .min_external_diameter = number_or_none(zone, "min_external_diameter")});
  }
  return result;
}

py::tuple zones_object(std::span<const Zone> zones) {
  py::list result;
  for (const Zone& zone : zones) {
    result.append(make_result("Zone", zone_shape_object(zone.shape), py::cast(zone.max_error),
                              py::cast(zone.min_external_diameter)));
  }
  return py::tuple(result);
}

void bind_zones(py::module_& module) {
  module.def(
      "read_zones",
      [](const py::object& path) { return zones_object(read_zones(path_of(path, "path"))); },
      py::arg("path"),
      Help("read_zones(path)", "The zones of a file as `spherule fit --zones` takes it.").c_str());
  module.def(
      "zones_text", [](const py::object& zones) { return zones_text(zones_of(zones)); },
      py::arg("zones"), Help("zones_text(zones)", "The text of such a file.").c_str());
  module.def(
      "concave_edge_zones",
      [](const py::object& mesh, double min_external_diameter, double max_error, double padding,
         double margin) {
        const ConcaveEdgeOptions options = {min_external_diameter, max_error, padding, margin};
        return zones_object(concave_edge_zones(*mesh_of(mesh, "mesh"), options));
      },
      py::arg("mesh"), py::kw_only(), py::arg("min_external_diameter"), py::arg("max_error"),
      py::arg("padding") = 0.0, py::arg("margin") = 0.0,
      Help("concave_edge_zones(mesh, *, min_external_diameter, max_error, padding=0.0, margin=0.0)",
           "Zones of a smaller D along the sharp concave edges of a mesh.")
          .c_str());
}

}  // namespace spherule::python
