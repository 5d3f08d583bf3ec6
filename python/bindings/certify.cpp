// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "python/bindings/long_run.h"
#include "simplifier/certificate.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/leak_points.h"
#include "simplifier/levels.h"
#include "simplifier/repair.h"
#include "spheretree/error.h"

namespace spherule::python {
namespace {

std::shared_ptr<const ExternalSpheres> required_external(py::handle value) {
  auto external = external_of(value, "external");
  if (!external) throw py::type_error("external: it is None");
  return external;
}

py::object certified(const py::object& mesh, const py::object& spheres_in,
                     const py::object& external, const py::object& zones, double padding,
                     double resolution, double protrusion_tolerance, bool volume, int threads,
                     const py::object& progress) {
  CertifyOptions options;
  options.padding = padding;
  options.resolution = resolution;
  options.protrusion_tolerance = protrusion_tolerance;
  options.volume = volume;
  options.threads = threads;
  return certificate_object(
      run_long(progress, [kept = mesh_of(mesh, "mesh"), all = spheres(spheres_in, "spheres").copy(),
                          solid = external_of(external, "external"), zones = zones_of(zones),
                          options](const LongRun& run) mutable {
        options.external = solid.get();
        options.zones = zones;
        options.progress = run.progress;
        return certify(*kept, all, options);
      }));
}

py::object repaired(const py::object& mesh, const py::object& external,
                    const py::object& spheres_in, double max_error, const py::object& zones,
                    std::uint64_t seed, int effort, int threads, const py::object& progress) {
  RepairOptions options;
  options.max_error = max_error;
  options.zones = zones_of(zones);
  options.seed = seed;
  options.effort = effort;
  options.threads = threads;
  return repair_object(run_long(
      progress, [kept = mesh_of(mesh, "mesh"), solid = required_external(external),
                 all = spheres(spheres_in, "spheres").copy(), options](const LongRun& run) mutable {
        options.progress = run.progress;
        return repair(*kept, *solid, all, options);
      }));
}

py::object fitted_levels(const py::object& mesh, const py::object& external,
                         const py::object& spheres_in, const py::object& max_errors,
                         double min_radius, std::uint64_t seed, int effort, double seconds,
                         int threads, const py::object& progress) {
  CoverOptions options;
  options.min_radius = min_radius;
  options.seed = seed;
  options.effort = effort;
  options.seconds = seconds;
  options.threads = threads;
  const Numbers errors = numbers(max_errors, "max_errors");
  return levels_object(
      run_long(progress, [kept = mesh_of(mesh, "mesh"), solid = required_external(external),
                          all = spheres(spheres_in, "spheres").copy(),
                          errors = std::vector<double>(errors.data, errors.data + errors.size),
                          options](const LongRun& run) mutable {
        options.progress = run.progress;
        options.stop = run.stop;
        return fit_levels(*kept, *solid, all, errors, options);
      }));
}

py::tuple leaks(const py::object& mesh, const py::object& spheres_in, double spacing,
                double separation, std::size_t max_count) {
  const LeakPointOptions options = {spacing, separation, max_count};
  const std::vector<LeakPoint> found = run_long(
      py::none(), [kept = mesh_of(mesh, "mesh"), all = spheres(spheres_in, "spheres").copy(),
                   options](const LongRun&) { return leak_points(*kept, all, options); });
  std::vector<Eigen::Vector3d> where;
  std::vector<double> depths;
  for (const LeakPoint& leak : found) {
    where.push_back(leak.point);
    depths.push_back(leak.depth);
  }
  return py::make_tuple(array_of(std::move(where)), array_of(std::move(depths)));
}

void bind_certify_itself(py::module_& module) {
  const CertifyOptions defaults;
  module.def(
      "certify", &certified, py::arg("mesh"), py::arg("spheres"), py::kw_only(),
      py::arg("external") = py::none(), py::arg("zones") = py::tuple(),
      py::arg("padding") = defaults.padding, py::arg("resolution") = defaults.resolution,
      py::arg("protrusion_tolerance") = defaults.protrusion_tolerance,
      py::arg("volume") = defaults.volume, py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help(
          "certify(mesh, spheres, *, external=None, zones=(), padding=0.0, "
          "resolution=0.000244140625, protrusion_tolerance=0.001953125, volume=True, threads=0, "
          "progress=None)",
          "Certifies any spheres, shape (n, 4), against a mesh: a Certificate.\n\nWith `external` "
          "(ExternalSpheres) against the simplified solid S, without it against the mesh and its "
          "inside. `resolution` is the smallest piece that is examined, `protrusion_tolerance` how "
          "closely the protrusion over the mesh is searched (0: not), both as shares of the box "
          "diagonal; `padding` is a length in the unit of the mesh.")
          .c_str());
}

void bind_repair(py::module_& module) {
  const RepairOptions defaults;
  module.def(
      "repair", &repaired, py::arg("mesh"), py::arg("external"), py::arg("spheres"), py::kw_only(),
      py::arg("max_error") = defaults.max_error, py::arg("zones") = py::tuple(),
      py::arg("seed") = defaults.seed, py::arg("effort") = defaults.effort,
      py::arg("threads") = defaults.threads, py::arg("progress") = py::none(),
      Help("repair(mesh, external, spheres, *, max_error=0.0, zones=(), seed=1, effort=60, "
           "threads=0, progress=None)",
           "Turns any spheres, shape (n, 4), into ones that cover S: a Repair. None is moved or "
           "made smaller; what is grown or added protrudes by at most `max_error` (0: the "
           "median of how far they protrude as they are).")
          .c_str());
}

void bind_levels(py::module_& module) {
  const CoverOptions defaults;
  module.def(
      "fit_levels", &fitted_levels, py::arg("mesh"), py::arg("external"), py::arg("spheres"),
      py::arg("max_errors"), py::kw_only(), py::arg("min_radius") = defaults.min_radius,
      py::arg("seed") = defaults.seed, py::arg("effort") = defaults.effort,
      py::arg("seconds") = defaults.seconds, py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help("fit_levels(mesh, external, spheres, max_errors, *, min_radius=0.0, seed=1, "
           "effort=60, seconds=0.0, threads=0, progress=None)",
           "Levels of detail above the cover `spheres`, shape (n, 4), for the errors given, all "
           "larger than that of the cover: a tuple of CoverLevel, the finest first. Each sphere "
           "of a level encloses its children.")
          .c_str());
}

void bind_leaks(py::module_& module) {
  const LeakPointOptions defaults;
  module.def(
      "leak_points", &leaks, py::arg("mesh"), py::arg("spheres"), py::kw_only(),
      py::arg("spacing") = defaults.spacing, py::arg("separation") = defaults.separation,
      py::arg("max_count") = defaults.max_count,
      Help("leak_points(mesh, spheres, *, spacing=0.0025, separation=0.04, max_count=500)",
           "Where the surface is outside of all spheres, the deepest point first: points of "
           "shape (n, 3) and depths of shape (n,). Samples: that none is found proves nothing. "
           "`spacing` and `separation` are shares of the box diagonal.")
          .c_str());
  module.def(
      "spheres_in_thin_parts",
      [](const py::object& external, const py::object& spheres_in, double max_error) {
        return spheres_in_thin_parts(*required_external(external),
                                     spheres(spheres_in, "spheres").span(), max_error);
      },
      py::arg("external"), py::arg("spheres"), py::arg("max_error"),
      Help("spheres_in_thin_parts(external, spheres, max_error)",
           "How many spheres have their centre within E of the outside of S.")
          .c_str());
}

}  // namespace

py::object repair_object(Repair repair) {
  return make_result("Repair", array_of(std::move(repair.spheres)), repair.inflated, repair.added,
                     repair.max_error, repair.protrusion_before, repair.protrusion_after,
                     repair.largest_inflation, repair.total_inflation);
}

void bind_certify(py::module_& module) {
  bind_certify_itself(module);
  bind_repair(module);
  bind_levels(module);
  bind_leaks(module);
}

}  // namespace spherule::python
