// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "python/bindings/certificates.h"
#include "python/bindings/support.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/leaks.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

using Optional = std::optional<double>;

Optional number_of(const py::object& object, const char* name) {
  return object.attr(name).cast<Optional>();
}

}  // namespace

py::object bounds_object(const Bounds& bounds) {
  return make_result("Bounds", bounds.lower, bounds.upper);
}

py::object certificate_object(const Certificate& c) {
  return make_result(
      "Certificate", c.covered, bounds_object(c.surface_depth), bounds_object(c.solid_depth),
      bounds_object(c.uncovered_depth), array_of(c.deepest_leak),
      py::cast(c.protrusion_over_simplified_max), py::tuple(py::cast(c.protrusion_in_zones)),
      c.protrusion_over_mesh ? bounds_object(*c.protrusion_over_mesh) : py::object(py::none()),
      py::cast(c.volume_ratio), py::cast(c.filled_volume), py::cast(c.filled_volume_error),
      py::cast(c.closing_slack), c.sphere_count, c.pieces, c.cells, record_object(record(c)));
}

py::object record_object(const std::optional<CertificateRecord>& record) {
  if (!record) return py::none();
  const CertificateRecord& r = *record;
  return make_result("CertificateRecord", r.covered, r.uncovered_depth_lower,
                     r.uncovered_depth_upper, py::cast(r.protrusion_over_simplified_max),
                     py::cast(r.protrusion_over_mesh_max), r.sphere_count, py::cast(r.volume_ratio),
                     py::cast(r.filled_volume), py::cast(r.filled_volume_error),
                     py::cast(r.closing_slack));
}

std::optional<CertificateRecord> record_of(const py::object& record) {
  if (record.is_none()) return std::nullopt;
  CertificateRecord r;
  r.covered = record.attr("covered").cast<bool>();
  r.uncovered_depth_lower = record.attr("uncovered_depth_lower").cast<double>();
  r.uncovered_depth_upper = record.attr("uncovered_depth_upper").cast<double>();
  r.protrusion_over_simplified_max = number_of(record, "protrusion_over_simplified_max");
  r.protrusion_over_mesh_max = number_of(record, "protrusion_over_mesh_max");
  r.sphere_count = record.attr("sphere_count").cast<std::size_t>();
  r.volume_ratio = number_of(record, "volume_ratio");
  r.filled_volume = number_of(record, "filled_volume");
  r.filled_volume_error = number_of(record, "filled_volume_error");
  r.closing_slack = number_of(record, "closing_slack");
  return r;
}

py::tuple levels_object(std::vector<CoverLevel> levels) {
  py::list result;
  for (CoverLevel& level : levels) {
    result.append(make_result("CoverLevel", level.max_error,
                              array_of(std::move(level.spheres.spheres)),
                              array_of(std::move(level.spheres.parent_of)), level.protrusion,
                              level.clustering_protrusion, level.clustering_count));
  }
  return py::tuple(result);
}

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
