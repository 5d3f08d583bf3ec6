// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/certificates.h"
#include "python/bindings/robots.h"
#include "python/bindings/support.h"
#include "robot/check/robot_collision.h"
#include "robot/cover/audit_robot.h"
#include "robot/cover/robot_spheres.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/proof_scope.h"

#include <array>
#include <pybind11/stl.h>
#include <tuple>

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

namespace {

using PairsPointer = std::shared_ptr<LinkPairs>;
using AllowedPointer = std::shared_ptr<AllowedOfRobot>;

constexpr std::array<std::string_view, 8> kReasons = {
    "tested", "rigid", "adjacent", "given", "never", "always", "proved never", "free in boxes"};

LinkMeshOptions mesh_options(const py::object& geometry, double chord_error, double weld) {
  return {.geometry = geometry_of(geometry), .chord_error = chord_error, .weld = weld};
}

// Bodies are named by the robot's links, of which there are as many.
py::tuple proved_pairs(const LinkPairs& pairs, const py::object& robot) {
  static constexpr const char* kVerdicts[] = {"never", "touching", "unknown"};
  const RobotModel& model = model_of(robot);
  const auto name_of_link = [&](int link) {
    return model.links().at(static_cast<std::size_t>(link)).name;
  };
  py::list result;
  for (const LinkPair& pair : pairs.pairs()) {
    result.append(make_result("LinkPair", name_of_link(pair.first), name_of_link(pair.second),
                              kVerdicts[static_cast<int>(pair.verdict)],
                              array_of(std::vector<double>(pair.witness)), pair.smallest_gap,
                              pair.boxes.free_share()));
  }
  return py::tuple(result);
}

PairsPointer proved(const py::object& robot, const py::object& geometry, double chord_error,
                    double weld, double padding, std::size_t boxes, std::size_t undecided_boxes,
                    std::size_t samples, double smallest_motion, double seconds, std::uint64_t seed,
                    int threads, const py::object& progress) {
  LinkPairOptions options;
  options.boxes = boxes;
  options.undecided_boxes = undecided_boxes;
  options.samples = samples;
  options.smallest_motion = smallest_motion;
  options.seconds = seconds;
  options.seed = seed;
  options.threads = threads;
  return run_long(progress, [kept = description_of(robot), padding,
                             of_mesh = mesh_options(geometry, chord_error, weld),
                             options](const LongRun& run) mutable {
    options.progress = run.progress;
    options.stop = run.stop;
    const auto bodies = link_bodies(*kept, of_mesh, padding);
    return std::make_shared<LinkPairs>(prove_link_pairs(kept->model, bodies, options));
  });
}

PairsPointer loaded_pairs(const py::object& path, const py::object& robot,
                          const py::object& geometry, double chord_error, double weld,
                          double padding) {
  return run_long(py::none(),
                  [file = path_of(path, "path"), kept = description_of(robot), padding,
                   of_mesh = mesh_options(geometry, chord_error, weld)](const LongRun&) {
                    const auto bodies = link_bodies(*kept, of_mesh, padding);
                    return std::make_shared<LinkPairs>(load_link_pairs(file, kept->model, bodies));
                  });
}

void bind_link_pairs(py::module_& module) {
  const LinkPairOptions defaults;
  const LinkMeshOptions of_mesh;
  py::class_<LinkPairs, PairsPointer>(
      module, "LinkPairs",
      "What is proved of the pairs of a robot's links that joints move against each other; "
      "prove_link_pairs() makes it, RobotScene.set_link_pairs() takes it. Immutable.")
      .def("pairs", &proved_pairs, py::arg("robot"),
           Help("pairs(self, robot)", "A tuple of LinkPair, named as the robot's links are.")
               .c_str())
      .def("__len__", [](const LinkPairs& pairs) { return pairs.pairs().size(); })
      .def("__repr__",
           [](const LinkPairs& pairs) {
             return "<spherule.LinkPairs: " + std::to_string(pairs.pairs().size()) + " pairs of " +
                    std::to_string(pairs.link_count()) + " links>";
           })
      .def(py::pickle(
          [](const LinkPairs& pairs) { return py::bytes(internal::encode_link_pairs(pairs)); },
          [](const py::bytes& bytes) {
            return std::make_shared<LinkPairs>(
                internal::decode_link_pairs(std::string_view(bytes), "pickle"));
          }));
  module.def(
      "prove_link_pairs", &proved, py::arg("robot"), py::kw_only(),
      py::arg("geometry") = "collision", py::arg("chord_error") = of_mesh.chord_error,
      py::arg("weld") = of_mesh.weld, py::arg("padding") = 0.0, py::arg("boxes") = defaults.boxes,
      py::arg("undecided_boxes") = defaults.undecided_boxes, py::arg("samples") = defaults.samples,
      py::arg("smallest_motion") = defaults.smallest_motion, py::arg("seconds") = defaults.seconds,
      py::arg("seed") = defaults.seed, py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help("prove_link_pairs(robot, *, geometry='collision', chord_error=0.0005, weld=0.0, "
           "padding=0.0, boxes=8000, undecided_boxes=100000, samples=300, "
           "smallest_motion=0.0001, seconds=0.0, seed=1, threads=0, progress=None)",
           "Proves what it can of all pairs of links of a RobotDescription, within the limits "
           "of the joints: LinkPairs. Metres; the bodies are the links' meshes grown by "
           "`padding`.")
          .c_str());
  module.def(
      "save_link_pairs",
      [](const LinkPairs& pairs, const py::object& path) {
        save_link_pairs(pairs, path_of(path, "path"));
      },
      py::arg("pairs"), py::arg("path"),
      Help("save_link_pairs(pairs, path)", "Writes proofs (docs/link-pairs-file.md).").c_str());
  module.def("load_link_pairs", &loaded_pairs, py::arg("path"), py::arg("robot"), py::kw_only(),
             py::arg("geometry") = "collision", py::arg("chord_error") = of_mesh.chord_error,
             py::arg("weld") = of_mesh.weld, py::arg("padding") = 0.0,
             Help("load_link_pairs(path, robot, *, geometry='collision', chord_error=0.0005, "
                  "weld=0.0, padding=0.0)",
                  "Reads proofs for the RobotDescription and the bodies they were made for.")
                 .c_str());
}

AllowedPointer made_allowed(const py::object& robot) {
  const RobotModel& model = model_of(robot);
  return std::make_shared<AllowedOfRobot>(AllowedOfRobot{model, AllowedCollisions(model)});
}

py::tuple allowed_pairs(const AllowedOfRobot& self) {
  const auto& names = self.allowed.link_names();
  py::list result;
  for (const AllowedCollisions::Pair& pair : self.allowed.pairs()) {
    result.append(py::make_tuple(names[static_cast<std::size_t>(pair.first)],
                                 names[static_cast<std::size_t>(pair.second)],
                                 std::string(word_of(pair.reason))));
  }
  return py::tuple(result);
}

py::tuple allowed_state(const AllowedOfRobot& self) {
  py::list pairs;
  for (const AllowedCollisions::Pair& pair : self.allowed.pairs()) {
    pairs.append(py::make_tuple(pair.first, pair.second, static_cast<int>(pair.reason)));
  }
  return py::make_tuple(std::make_shared<RobotModel>(self.robot), pairs);
}

AllowedPointer allowed_from(const py::tuple& state) {
  const AllowedPointer made = made_allowed(state[0]);
  AllowedCollisions& allowed = made->allowed;
  const std::vector<std::string> names = allowed.link_names();
  for (const AllowedCollisions::Pair& pair : allowed.pairs()) {
    allowed.forbid(names[static_cast<std::size_t>(pair.first)],
                   names[static_cast<std::size_t>(pair.second)]);
  }
  for (const py::handle entry : state[1]) {
    const auto pair = entry.cast<std::tuple<int, int, int>>();
    allowed.allow(std::get<0>(pair), std::get<1>(pair),
                  static_cast<AllowedReason>(std::get<2>(pair)));
  }
  return made;
}

void allow_disabled(AllowedOfRobot& self, const py::object& pairs) {
  self.allowed.allow(pairs_of(pairs));
}

void apply_srdf(AllowedOfRobot& self, const py::object& semantics) {
  SemanticDescription given;
  given.disabled_pairs = pairs_of(semantics.attr("disabled_pairs"));
  given.links_disabled_by_default =
      semantics.attr("links_disabled_by_default").cast<std::vector<std::string>>();
  given.enabled_pairs =
      semantics.attr("enabled_pairs").cast<std::vector<std::pair<std::string, std::string>>>();
  self.allowed.apply(given);
}

py::object allow_by_samples(AllowedOfRobot& self, std::size_t configurations, std::uint64_t seed) {
  // Other threads may edit them while this one does not hold the lock.
  SampledCollisions found = [&, allowed = self.allowed] {
    const WithoutLock unlocked;
    return sample_collisions(self.robot, allowed, {configurations, seed});
  }();
  allow_sampled(found, self.allowed);
  return py::int_(found.configurations);
}

void bind_allowed(py::module_& module) {
  const SampleCollisionsOptions defaults;
  using Names = const std::string&;
  py::class_<AllowedOfRobot, AllowedPointer>(
      module, "AllowedCollisions",
      Help("AllowedCollisions(robot)",
           "Which pairs of a robot's links may touch each other, and why. At first those that no "
           "joint "
           "moves against each other, and those that one joint joins.")
          .c_str())
      .def(py::init(&made_allowed), py::arg("robot"))
      .def(
          "allow", [](AllowedOfRobot& self, Names a, Names b) { self.allowed.allow(a, b); },
          py::arg("first"), py::arg("second"),
          Help("allow(self, first, second)", "The two links may touch.").c_str())
      .def("allow_pairs", &allow_disabled, py::arg("pairs"),
           Help("allow_pairs(self, pairs)",
                "The pairs that an SRDF disables: DisabledPair, or what has `link_a` and `link_b`.")
               .c_str())
      .def("apply", &apply_srdf, py::arg("semantics"),
           Help("apply(self, semantics)",
                "As a SemanticDescription says: pairs that it disables, by the default of a link, "
                "too, are allowed, and those that it enables are tested. Those of other robots' "
                "links are passed over.")
               .c_str())
      .def(
          "allow_all", [](AllowedOfRobot& self) { self.allowed.allow_all(); },
          Help("allow_all(self)", "Every pair.").c_str())
      .def("allow_sampled", &allow_by_samples, py::kw_only(),
           py::arg("configurations") = defaults.configurations, py::arg("seed") = defaults.seed,
           Help("allow_sampled(self, *, configurations=10000, seed=1)",
                "What never touched in so many random configurations, and what always did: likely, "
                "not proved.")
               .c_str())
      .def(
          "forbid", [](AllowedOfRobot& self, Names a, Names b) { self.allowed.forbid(a, b); },
          py::arg("first"), py::arg("second"),
          Help("forbid(self, first, second)", "Tests the two again.").c_str())
      .def(
          "allows",
          [](const AllowedOfRobot& self, Names a, Names b) { return self.allowed.allows(a, b); },
          py::arg("first"), py::arg("second"),
          Help("allows(self, first, second)", "Whether the two links may touch.").c_str())
      .def("pairs", &allowed_pairs,
           Help("pairs(self)", "The names of all allowed pairs, and the reason of each.").c_str())
      .def("__repr__",
           [](const AllowedOfRobot& self) {
             return "<spherule.AllowedCollisions: " + std::to_string(self.allowed.pairs().size()) +
                    " pairs of " + std::to_string(self.allowed.link_names().size()) + " links>";
           })
      .def(py::pickle(&allowed_state, &allowed_from));
}

}  // namespace

std::string_view word_of(AllowedReason reason) {
  return kReasons.at(static_cast<std::size_t>(reason));
}

void bind_pairs(py::module_& module) {
  bind_link_pairs(module);
  bind_allowed(module);
}

}  // namespace spherule::python
