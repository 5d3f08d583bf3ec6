// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "python/bindings/certificates.h"
#include "python/bindings/support.h"
#include "simplifier/concave_edges.h"
#include "simplifier/types/zones.h"

#include <pybind11/stl.h>
#include <type_traits>

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

namespace {

py::object history_object(const std::vector<CoverHistoryEntry>& history) {
  py::list result;
  for (const CoverHistoryEntry& e : history) {
    result.append(make_result("CoverHistoryEntry", e.sphere_count, e.max_error_lower,
                              e.max_error_upper, e.surface_error_before, e.surface_error_after,
                              e.coverage_before, e.coverage_after, e.excess_before,
                              e.excess_after));
  }
  return py::tuple(result);
}

py::object sphere_cover_object(SphereCover cover) {
  return make_result("SphereCover", array_of(std::move(cover.spheres)), cover.lower_bound,
                     array_of(std::move(cover.spheres_before_inflation)), cover.inflation,
                     history_object(cover.history), cover.seeds_rejected);
}

// The keyword arguments as options. Those that are lengths, numbers and truths are taken by name.
SimplifyOptions options_of(const py::kwargs& given) {
  SimplifyOptions o;
  const auto take = [&](const char* name, auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    try {
      value = given[name].cast<Value>();
    } catch (const py::cast_error&) {
      const std::string type = py::str(py::type::handle_of(given[name]).attr("__name__"));
      if (std::is_arithmetic_v<Value> && type == "int") {
        throw Error(name, std::string(py::str(py::object(given[name]))) + " is out of range");
      }
      throw py::type_error(std::string(name) + ": its type is " + type);
    }
  };
  take("max_error", o.max_error);
  take("levels", o.levels);
  take("min_external_diameter", o.min_external_diameter);
  take("tightness", o.tightness);
  take("padding", o.padding);
  take("min_radius", o.min_radius);
  o.zones = zones_of(given["zones"]);
  take("keep_concave_edges", o.keep_concave_edges);
  o.method = static_cast<CoverMethod>(choice(given["method"], {"cover", "paper"}, "method"));
  o.external = static_cast<ExternalPlacement>(
      choice(given["external"], {"reachable", "random", "none"}, "external"));
  take("external_limit", o.external_limit);
  take("min_internal_diameter", o.min_internal_diameter);
  take("seed", o.seed);
  take("effort", o.effort);
  take("seconds", o.seconds);
  take("lower_bound", o.lower_bound);
  take("history", o.history);
  take("threads", o.threads);
  return o;
}

py::object simplified(const py::object& mesh, const py::object& progress, const py::kwargs& given) {
  SimplifyOptions options = options_of(given);
  return simplification_object(
      run_long(progress, [kept = mesh_of(mesh, "mesh"), options](const LongRun& run) mutable {
        options.progress = run.progress;
        options.stop = run.stop;
        Simplification result = simplify(*kept, options);
        result.options.progress = {};
        return result;
      }));
}

}  // namespace

py::object simplification_object(Simplification all) {
  const std::string broken = broken_promises(all);
  py::object file = file_object(sphere_file(all));
  py::dict times;
  times["external"] = all.times.external;
  times["cover"] = all.times.cover;
  times["levels"] = all.times.levels;
  times["certify"] = all.times.certify;
  return make_result("Simplification", sphere_cover_object(std::move(all.cover)),
                     std::make_shared<ExternalSpheres>(std::move(all.external)),
                     levels_object(std::move(all.levels)), certificate_object(all.certificate),
                     file, times, broken, all.larger_diameter);
}

void bind_simplify(py::module_& module) {
  // _functions.py has the arguments and their defaults.
  module.def("_simplify", &simplified, py::arg("mesh"), py::arg("progress"));
  module.def(
      "tool_diameter",
      [](const py::object& tool) { return tool_diameter(spheres(tool, "tool").span()); },
      py::arg("tool"),
      Help("tool_diameter(tool)",
           "D for a tool that is a union of spheres, shape (n, 4): the diameter of the smallest.")
          .c_str());
}

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
