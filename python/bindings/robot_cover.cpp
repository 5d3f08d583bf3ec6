// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/certificates.h"
#include "python/bindings/long_run.h"
#include "python/bindings/robots.h"
#include "robot/cover/audit_robot.h"
#include "robot/cover/repair_robot.h"
#include "robot/cover/robot_spheres.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

LinkCoverOptions link_options_of(py::handle options) {
  using Optional = std::optional<double>;
  return {.max_error = options.attr("max_error").cast<Optional>(),
          .min_external_diameter = options.attr("min_external_diameter").cast<Optional>(),
          .padding = options.attr("padding").cast<Optional>(),
          .zones = zones_of(options.attr("zones"))};
}

py::object cover_object(const RobotDescription& robot, RobotCover cover) {
  const RobotSpheres all = robot_spheres(robot, cover);
  const auto not_proved = py::tuple(py::cast(links_not_proved(cover)));
  py::list links;
  for (LinkCover& link : cover.links) {
    py::object fit = py::none();
    if (link.fit) fit = simplification_object(std::move(*link.fit));
    links.append(make_result("LinkCover", link.link, array_of(std::move(link.spheres)), fit,
                             link.triangles, link.vertex_error, link.seconds,
                             py::tuple(py::cast(link.warnings))));
  }
  return make_result("RobotCover", cover.robot, py::tuple(links), not_proved,
                     robot_spheres_object(all, ""));
}

py::object covered_robot(const py::object& robot, double max_error, double min_external_diameter,
                         double tightness, double padding, double weld, const py::object& geometry,
                         const py::dict& links, std::uint64_t seed, int effort, double seconds,
                         int threads, const py::object& progress) {
  RobotCoverOptions options;
  options.max_error = max_error;
  options.min_external_diameter = min_external_diameter;
  options.tightness = tightness;
  options.padding = padding;
  options.weld = weld;
  options.geometry = geometry_of(geometry);
  for (const auto& [name, of_link] : links) {
    options.links.emplace(py::str(name), link_options_of(of_link));
  }
  options.seed = seed;
  options.effort = effort;
  options.seconds = seconds;
  options.threads = threads;
  const auto kept = description_of(robot);
  return cover_object(*kept, run_long(progress, [kept, options](const LongRun& run) mutable {
    options.progress = run.progress;
    options.stop = run.stop;
    return cover_robot(*kept, options);
  }));
}

py::object audit_object(const RobotAudit& audit) {
  py::list links;
  for (const LinkAudit& link : audit.links) {
    links.append(make_result(
        "LinkAudit", link.link, link.spheres,
        link.certificate ? certificate_object(*link.certificate) : py::object(py::none()),
        link.uncovered_share, py::tuple(py::cast(link.warnings))));
  }
  py::list configurations;
  for (const ConfigurationAudit& at : audit.configurations) {
    configurations.append(make_result(
        "ConfigurationAudit", bounds_object(at.uncovered_depth), at.deepest_link,
        at.deepest_leak ? py::object(array_of(*at.deepest_leak)) : py::object(py::none())));
  }
  return make_result("RobotAudit", py::tuple(links), py::tuple(configurations),
                     py::tuple(py::cast(audit.unknown_links)), audit.links_covered,
                     audit.configurations_covered);
}

py::object audited_robot(const py::object& robot, const py::object& spheres_in,
                         const py::object& geometry, double max_error, double min_external_diameter,
                         const py::object& configurations, int threads,
                         const py::object& progress) {
  const auto kept = description_of(robot);
  RobotAuditOptions options;
  options.geometry = geometry_of(geometry);
  options.max_error = max_error;
  options.min_external_diameter = min_external_diameter;
  options.threads = threads;
  const auto dof = static_cast<std::size_t>(kept->model.variable_count());
  const Numbers rows = table(configurations, dof, "configurations");
  for (std::size_t i = 0; dof > 0 && i < rows.size / dof; ++i) {
    options.configurations.emplace_back(rows.data + i * dof, rows.data + (i + 1) * dof);
  }
  return audit_object(run_long(
      progress, [kept, all = link_spheres_of(spheres_in), options](const LongRun& run) mutable {
        options.progress = run.progress;
        return audit_robot(*kept, all, options);
      }));
}

py::object repaired_robot(const py::object& robot, const py::object& spheres_in,
                          const py::object& geometry, double max_error, int threads,
                          const py::object& progress) {
  RobotRepairOptions options;
  options.geometry = geometry_of(geometry);
  options.max_error = max_error;
  options.threads = threads;
  RobotRepair repair =
      run_long(progress, [kept = description_of(robot), all = link_spheres_of(spheres_in),
                          options](const LongRun& run) mutable {
        options.progress = run.progress;
        return repair_robot(*kept, all, options);
      });
  py::list links;
  for (LinkRepair& link : repair.links) {
    links.append(make_result("LinkRepair", link.link, repair_object(std::move(link.repair)),
                             certificate_object(link.certificate),
                             py::tuple(py::cast(link.warnings))));
  }
  return make_result("RobotRepair", spheres_object(repair.spheres), py::tuple(links));
}

void bind_cover(py::module_& module) {
  const RobotCoverOptions defaults;
  module.def(
      "cover_robot", &covered_robot, py::arg("robot"), py::kw_only(),
      py::arg("max_error") = defaults.max_error,
      py::arg("min_external_diameter") = defaults.min_external_diameter,
      py::arg("tightness") = defaults.tightness, py::arg("padding") = defaults.padding,
      py::arg("weld") = defaults.weld, py::arg("geometry") = "collision",
      py::arg("links") = py::dict(), py::arg("seed") = defaults.seed,
      py::arg("effort") = defaults.effort, py::arg("seconds") = defaults.seconds,
      py::arg("threads") = defaults.threads, py::arg("progress") = py::none(),
      Help("cover_robot(robot, *, max_error=0.01, min_external_diameter=0.0, tightness=0.03, "
           "padding=0.0, weld=0.0, geometry='collision', links={}, seed=1, effort=60, seconds=0.0, "
           "threads=0, progress=None)",
           "Covers the geometry ('collision' or 'visual') of every link of a RobotDescription with "
           "spheres and certifies them: a RobotCover. Lengths in metres; `max_error` is E, "
           "`min_external_diameter` D (0: 4 E, or more for a link that is very large for its E, "
           "with a warning). `links` are LinkCoverOptions by the link's name. `progress` is called "
           "with a link's name.")
          .c_str());
}

}  // namespace

LinkGeometry geometry_of(py::handle geometry) {
  return static_cast<LinkGeometry>(choice(geometry, {"collision", "visual"}, "geometry"));
}

void bind_robot_cover(py::module_& module) {
  bind_cover(module);
  const RobotAuditOptions defaults;
  module.def(
      "audit_robot", &audited_robot, py::arg("robot"), py::arg("spheres"), py::kw_only(),
      py::arg("geometry") = "collision", py::arg("max_error") = defaults.max_error,
      py::arg("min_external_diameter") = defaults.min_external_diameter,
      py::arg("configurations") = py::tuple(), py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help(
          "audit_robot(robot, spheres, *, geometry='collision', max_error=0.01, "
          "min_external_diameter=0.0, configurations=(), threads=0, progress=None)",
          "Certifies the spheres of a robot, of any origin, against its own meshes: a RobotAudit. "
          "`spheres` is RobotSpheres, or a dict of arrays of shape (n, 4) by link; `max_error` and "
          "`min_external_diameter` are E and D for which they were made, as cover_robot() has "
          "them. "
          "In `configurations`, shape (n, dof), the robot is judged as a whole.")
          .c_str());
  module.def(
      "repair_robot", &repaired_robot, py::arg("robot"), py::arg("spheres"), py::kw_only(),
      py::arg("geometry") = "collision", py::arg("max_error") = 0.0, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      Help("repair_robot(robot, spheres, *, geometry='collision', max_error=0.0, threads=0, "
           "progress=None)",
           "Makes the spheres of every link cover its mesh: a RobotRepair. No sphere is moved "
           "or made smaller; `max_error` 0 chooses for each link.")
          .c_str());
}

}  // namespace spherule::python
