// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "spheretree/sphere_file.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

py::object pose_or_none(const std::optional<BodyCopy>& copy) {
  return copy ? py::cast(copy->pose) : py::object(py::none());
}

py::object body_object(const BodyRecord& body) {
  return make_result("BodyRecord", body.name, body.sphere_count, record_object(body.certificate),
                     py::cast(body.options), copy_of(body.copy), pose_or_none(body.copy),
                     body.interrupted);
}

std::vector<BodyRecord> bodies_of(const py::object& bodies) {
  std::vector<BodyRecord> result;
  for (const py::handle body : bodies) {
    BodyRecord& record = result.emplace_back();
    record.name = py::str(body.attr("name"));
    record.sphere_count = body.attr("sphere_count").cast<std::size_t>();
    record.certificate = record_of(body.attr("certificate"));
    record.options = body.attr("options").cast<std::map<std::string, OptionValue>>();
    record.interrupted = body.attr("interrupted").cast<bool>();
    if (body.attr("copy_of").is_none()) continue;
    record.copy = {body.attr("copy_of").cast<std::size_t>(), pose_of(body.attr("pose"), "pose")};
  }
  return result;
}

void save_file(const py::object& file, const py::object& path) {
  SphereFile content = file_of(file);
  save_spheres(content, path_of(path, "path"));
}

}  // namespace

py::object copy_of(const std::optional<BodyCopy>& copy) {
  return copy ? py::object(py::int_(copy->of)) : py::object(py::none());
}

py::object file_object(SphereFile file) {
  py::list bodies;
  for (const BodyRecord& body : file.bodies) bodies.append(body_object(body));
  return make_result("SphereFile", array_of(std::move(file.spheres)),
                     record_object(file.certificate), py::cast(file.options), py::tuple(bodies),
                     file.interrupted);
}

SphereFile file_of(const py::object& file) {
  return {.spheres = spheres(file.attr("spheres"), "spheres").copy(),
          .certificate = record_of(file.attr("certificate")),
          .options = file.attr("options").cast<std::map<std::string, OptionValue>>(),
          .bodies = bodies_of(file.attr("bodies")),
          .interrupted = file.attr("interrupted").cast<bool>()};
}

void bind_sphere_files(py::module_& module) {
  module.def("save_spheres", &save_file, py::arg("file"), py::arg("path"),
             Help("save_spheres(file, path)",
                  "Writes a SphereFile as SPHERES.json. Of a Simplification it is `.file`; "
                  "SphereFile(spheres) makes one of any spheres.")
                 .c_str());
  module.def(
      "load_spheres",
      [](const py::object& path) { return file_object(load_spheres(path_of(path, "path"))); },
      py::arg("path"),
      Help("load_spheres(path)", "Reads SPHERES.json: a SphereFile, doubles bit for bit.").c_str());
}

}  // namespace spherule::python
