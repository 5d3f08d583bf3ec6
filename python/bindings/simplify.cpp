// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "python/bindings/long_run.h"
#include "spheretree/error.h"

#include <pybind11/stl.h>
#include <type_traits>

namespace spherule::python {
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

}  // namespace spherule::python
