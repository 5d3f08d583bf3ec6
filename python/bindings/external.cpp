// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "python/bindings/long_run.h"
#include "simplifier/external_spheres.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

using ExternalPointer = std::shared_ptr<ExternalSpheres>;

py::tuple external_state(const py::object& self) {
  const auto& external = self.cast<const ExternalSpheres&>();
  return py::make_tuple(view(external.spheres, self), array_of(external.box),
                        external.min_external_diameter, external.padding, external.grid_step,
                        external.nodes_examined, external.closing_slack,
                        zones_object(external.concave_edges));
}

ExternalPointer external_from(const py::tuple& state) {
  const Numbers box = numbers(state[1], "box");
  const auto corner = [&](std::size_t i) {
    return Eigen::Vector3d(box.data[3 * i], box.data[3 * i + 1], box.data[3 * i + 2]);
  };
  return std::make_shared<ExternalSpheres>(
      ExternalSpheres{.spheres = spheres(state[0], "spheres").copy(),
                      .box = {corner(0), corner(1)},
                      .min_external_diameter = state[2].cast<double>(),
                      .padding = state[3].cast<double>(),
                      .grid_step = state[4].cast<double>(),
                      .nodes_examined = state[5].cast<std::size_t>(),
                      .closing_slack = state[6].cast<double>(),
                      .concave_edges = zones_of(state[7])});
}

ExternalPointer place(const py::object& mesh, double min_external_diameter, double max_error,
                      double padding, double grid_step, std::size_t max_cells, double tightness,
                      const py::object& zones, bool keep_concave_edges, const py::object& placement,
                      std::size_t limit, std::uint64_t seed, int threads,
                      const py::object& progress) {
  ExternalOptions options;
  options.placement = static_cast<ExternalPlacement>(
      choice(placement, {"reachable", "random", "none"}, "placement"));
  options.min_external_diameter = min_external_diameter;
  options.padding = padding;
  options.grid_step = grid_step;
  options.max_cells = max_cells;
  options.max_error = max_error;
  options.tightness = tightness;
  options.zones = zones_of(zones);
  options.keep_concave_edges = keep_concave_edges;
  options.limit = limit;
  options.seed = seed;
  options.threads = threads;
  return run_long(progress, [kept = mesh_of(mesh, "mesh"), options](const LongRun& run) mutable {
    options.progress = run.progress;
    return std::make_shared<ExternalSpheres>(place_external_spheres(*kept, options));
  });
}

void bind_external_class(py::module_& module) {
  py::class_<ExternalSpheres, ExternalPointer>(
      module, "ExternalSpheres",
      "Stage 1's result, which defines the simplified solid S exactly: the closed box minus the "
      "union of the open spheres. Lengths in the unit of the mesh.")
      .def_property_readonly(
          "spheres",
          [](const py::object& self) {
            return view(self.cast<const ExternalSpheres&>().spheres, self);
          },
          "Shape (n, 4), read-only, no copy.")
      .def_property_readonly(
          "box", [](const ExternalSpheres& external) { return array_of(external.box); },
          "Low and high corner, shape (2, 3).")
      .def_readonly("min_external_diameter", &ExternalSpheres::min_external_diameter, "D.")
      .def_readonly("padding", &ExternalSpheres::padding, "t, the mesh's vertex_error included.")
      .def_readonly("grid_step", &ExternalSpheres::grid_step, "Of the flood.")
      .def_readonly("nodes_examined", &ExternalSpheres::nodes_examined)
      .def_readonly("closing_slack", &ExternalSpheres::closing_slack,
                    "Proved: how much wider than D a way may be and still have been closed.")
      .def_property_readonly(
          "concave_edges",
          [](const ExternalSpheres& external) { return zones_object(external.concave_edges); })
      .def("__eq__",
           [](const ExternalSpheres& a, const py::object& other) {
             if (!py::isinstance<ExternalSpheres>(other)) return false;
             const auto& b = other.cast<const ExternalSpheres&>();
             return a.spheres == b.spheres && a.box.min() == b.box.min() &&
                    a.box.max() == b.box.max() &&
                    a.min_external_diameter == b.min_external_diameter && a.padding == b.padding &&
                    a.closing_slack == b.closing_slack;
           })
      .def("__len__", [](const ExternalSpheres& external) { return external.spheres.size(); })
      .def("__repr__",
           [](const ExternalSpheres& external) {
             return "<spherule.ExternalSpheres: " + std::to_string(external.spheres.size()) +
                    " spheres of diameter " +
                    std::string(py::str(py::float_(external.min_external_diameter))) + " at least>";
           })
      .def(py::pickle(&external_state, &external_from));
}

}  // namespace

std::shared_ptr<const ExternalSpheres> external_of(py::handle value, const char* name) {
  if (value.is_none()) return nullptr;
  if (!py::isinstance<ExternalSpheres>(value)) {
    throw py::type_error(std::string(name) + ": it is neither ExternalSpheres nor None");
  }
  return value.cast<ExternalPointer>();
}

void bind_external(py::module_& module) {
  bind_external_class(module);
  const ExternalOptions defaults;
  module.def(
      "place_external_spheres", &place, py::arg("mesh"), py::kw_only(),
      py::arg("min_external_diameter"), py::arg("max_error") = defaults.max_error,
      py::arg("padding") = defaults.padding, py::arg("grid_step") = defaults.grid_step,
      py::arg("max_cells") = defaults.max_cells, py::arg("tightness") = defaults.tightness,
      py::arg("zones") = py::tuple(), py::arg("keep_concave_edges") = defaults.keep_concave_edges,
      py::arg("placement") = "reachable", py::arg("limit") = defaults.limit,
      py::arg("seed") = defaults.seed, py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help(
          "place_external_spheres(mesh, *, min_external_diameter, max_error=0.0, padding=0.0, "
          "grid_step=0.0, max_cells=134217728, tightness=0.03, zones=(), keep_concave_edges=False, "
          "placement='reachable', limit=100000, seed=1, threads=0, progress=None)",
          "Stage 1: the spheres of diameter D around the mesh, an ExternalSpheres. Lengths in the "
          "unit of the mesh. `placement` is 'reachable', 'random' or 'none'; `limit` and `seed` "
          "are "
          "those of 'random'. simplify() does it by itself.")
          .c_str());
}

}  // namespace spherule::python
