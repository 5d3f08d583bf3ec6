// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/certificates.h"

#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"

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

}  // namespace spherule::python
