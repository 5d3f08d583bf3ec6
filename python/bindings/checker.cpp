// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/robots.h"
#include "python/bindings/support.h"

#include <algorithm>
#include <chrono>
#include <pybind11/stl.h>
#include <thread>

namespace spherule::python {
namespace {

using CheckerPointer = std::shared_ptr<CheckerOfScene>;

// A scratch that is lent for a query, made and given back under the interpreter's lock.
class LentScratch {
 public:
  explicit LentScratch(CheckerOfScene& self) : self_(self), scratch_(taken(self)) {}
  ~LentScratch() { self_.idle.push_back(std::move(scratch_)); }
  LentScratch(const LentScratch&) = delete;
  LentScratch& operator=(const LentScratch&) = delete;

  static RobotChecker::Scratch taken(CheckerOfScene& self) {
    if (self.idle.empty()) return RobotChecker::Scratch(self.checker);
    RobotChecker::Scratch scratch = std::move(self.idle.back());
    self.idle.pop_back();
    return scratch;
  }
  RobotChecker::Scratch& operator*() { return scratch_; }

 private:
  CheckerOfScene& self_;
  RobotChecker::Scratch scratch_;
};

// More threads are of no use, unless there are more cores.
constexpr std::size_t kUsefulThreads = 64;

// A scratch for each thread, lent likewise.
class Scratches {
 public:
  Scratches(CheckerOfScene& self, int threads) : self_(self) {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    std::size_t count = static_cast<std::size_t>(std::max(threads, 0));
    count = count == 0 ? cores : std::min(count, std::max(cores, kUsefulThreads));
    while (lent_.size() < count) lent_.push_back(LentScratch::taken(self));
  }
  ~Scratches() {
    for (RobotChecker::Scratch& scratch : lent_) self_.idle.push_back(std::move(scratch));
  }
  Scratches(const Scratches&) = delete;
  Scratches& operator=(const Scratches&) = delete;

  std::span<RobotChecker::Scratch> all() { return lent_; }

 private:
  CheckerOfScene& self_;
  std::vector<RobotChecker::Scratch> lent_;
};

std::span<const double> configuration_of(const CheckerOfScene& self, const Numbers& numbers) {
  return {numbers.data, self.dof};
}

Numbers configuration_in(const CheckerOfScene& self, py::handle value, const char* name) {
  return row(value, self.dof, name);
}

// Calls `work(first, count)` for parts of so many that each takes about a tenth of a second,
// without the lock, and looks for signals in between.
template <class Work>
void in_parts(std::size_t count, const Work& work) {
  using Clock = std::chrono::steady_clock;
  std::size_t part = 512;
  for (std::size_t first = 0; first < count;) {
    const std::size_t size = std::min(part, count - first);
    const auto start = Clock::now();
    {
      const WithoutLock unlocked;
      work(first, size);
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double fitting = 0.1 * static_cast<double>(size) / std::max(seconds, 1e-9);
    part = static_cast<std::size_t>(std::clamp(fitting, 1.0, 8.0 * static_cast<double>(part)));
    first += size;
    require_no_signal();
  }
}

bool check_one(CheckerOfScene& self, const py::object& configuration) {
  const Numbers positions = configuration_in(self, configuration, "configuration");
  LentScratch scratch(self);
  const WithoutLock unlocked;
  return self.checker.check_config(configuration_of(self, positions), *scratch);
}

py::array check_many(CheckerOfScene& self, const py::object& configurations, int threads) {
  const Numbers all = table(configurations, self.dof, "configurations");
  const std::size_t count = row_count(all);
  py::array_t<bool> free(static_cast<py::ssize_t>(count));
  auto* const answers = reinterpret_cast<std::uint8_t*>(free.mutable_data());
  Scratches scratches(self, threads);
  in_parts(count, [&](std::size_t first, std::size_t size) {
    const std::span<const double> part(all.data + first * self.dof, size * self.dof);
    self.checker.check_configs(part, scratches.all(), {answers + first, size});
  });
  return free;
}

EdgeRequest edge_request(double resolution, bool first, const py::object& continuous,
                         const py::object& max_configurations) {
  return {.resolution = resolution,
          .first = first,
          .continuous = static_cast<ContinuousMotion>(
              choice(continuous, {"as_given", "shortest"}, "continuous")),
          .max_configurations = count_of(max_configurations, "max_configurations")};
}

py::object check_one_edge(CheckerOfScene& self, const py::object& from, const py::object& to,
                          double resolution, bool first, const py::object& continuous,
                          const py::object& max_configurations) {
  const Numbers a = configuration_in(self, from, "start");
  const Numbers b = configuration_in(self, to, "end");
  const EdgeRequest request = edge_request(resolution, first, continuous, max_configurations);
  LentScratch scratch(self);
  const EdgeResult found = [&] {
    const WithoutLock unlocked;
    return self.checker.check_edge(configuration_of(self, a), configuration_of(self, b), *scratch,
                                   request);
  }();
  return make_result("EdgeResult", verdict_of(found.verdict), found.free_until, found.contact_at,
                     found.configurations);
}

py::object check_many_edges(CheckerOfScene& self, const py::object& from, const py::object& to,
                            double resolution, bool first, const py::object& continuous,
                            const py::object& max_configurations, int threads) {
  const Numbers a = table(from, self.dof, "start");
  const Numbers b = table(to, self.dof, "end");
  const std::size_t count = row_count(a);
  if (row_count(b) != count) {
    throw Error("end",
                "its shape is " + shape_text(b.array) + ", that of start " + shape_text(a.array));
  }
  const EdgeRequest request = edge_request(resolution, first, continuous, max_configurations);
  std::vector<std::int32_t> verdicts(count);
  std::vector<double> free_until(count);
  std::vector<double> contact_at(count);
  Scratches scratches(self, threads);
  in_parts(count, [&](std::size_t at, std::size_t size) {
    const std::size_t begin = at * self.dof;
    const std::size_t numbers = size * self.dof;
    // Of a robot that does not move the library cannot tell how many there are.
    const auto found =
        self.dof > 0
            ? self.checker.check_edges({a.data + begin, numbers}, {b.data + begin, numbers},
                                       scratches.all(), request)
            : std::vector(size, self.checker.check_edge({}, {}, scratches.all().front(), request));
    for (std::size_t i = 0; i < size; ++i) {
      verdicts[at + i] = static_cast<std::int32_t>(found[i].verdict);
      free_until[at + i] = found[i].free_until;
      contact_at[at + i] = found[i].contact_at;
    }
  });
  return make_result("EdgeResults", array_of(std::move(verdicts)), array_of(std::move(free_until)),
                     array_of(std::move(contact_at)));
}

double measure_one_edge(CheckerOfScene& self, const py::object& from, const py::object& to,
                        double resolution, const py::object& continuous) {
  const Numbers a = configuration_in(self, from, "start");
  const Numbers b = configuration_in(self, to, "end");
  const EdgeRequest request = edge_request(resolution, false, continuous, py::none());
  LentScratch scratch(self);
  const WithoutLock unlocked;
  return self.checker.measure_edge(configuration_of(self, a), configuration_of(self, b), *scratch,
                                   request.resolution, request.continuous);
}

bool is_within(CheckerOfScene& self, const py::object& configuration, double clearance) {
  const Numbers positions = configuration_in(self, configuration, "configuration");
  LentScratch scratch(self);
  const WithoutLock unlocked;
  return self.checker.within(configuration_of(self, positions), clearance, *scratch);
}

py::object checked_body(const CheckedBody& body) {
  static constexpr const char* kKinds[] = {"link", "attached", "obstacle"};
  return make_result("CheckedBody", kKinds[static_cast<int>(body.kind)], body.name, body.tree,
                     body.sphere);
}

py::object clearance_of(CheckerOfScene& self, const py::object& configuration) {
  const Numbers positions = configuration_in(self, configuration, "configuration");
  LentScratch scratch(self);
  const RobotClearance found = [&] {
    const WithoutLock unlocked;
    return self.checker.clearance(configuration_of(self, positions), *scratch);
  }();
  return make_result("RobotClearance", found.lower, found.upper, checked_body(found.first),
                     checked_body(found.second));
}

py::array clearances_of(CheckerOfScene& self, const py::object& configurations) {
  const Numbers all = table(configurations, self.dof, "configurations");
  const std::size_t count = row_count(all);
  py::array_t<double> bounds({static_cast<py::ssize_t>(count), py::ssize_t{2}});
  double* const answers = bounds.mutable_data();
  LentScratch scratch(self);
  in_parts(count, [&](std::size_t first, std::size_t size) {
    for (std::size_t i = first; i < first + size; ++i) {
      const std::span<const double> positions(all.data + i * self.dof, self.dof);
      const RobotClearance found = self.checker.clearance(positions, *scratch);
      answers[2 * i] = found.lower;
      answers[2 * i + 1] = found.upper;
    }
  });
  return bounds;
}

py::tuple explained(CheckerOfScene& self, const py::object& configuration,
                    const py::object& max_contacts, bool proved_free) {
  const Numbers positions = configuration_in(self, configuration, "configuration");
  const ExplainRequest request = {.max_contacts = count_of(max_contacts, "max_contacts"),
                                  .proved_free = proved_free};
  LentScratch scratch(self);
  const auto found = [&] {
    const WithoutLock unlocked;
    return self.checker.explain(configuration_of(self, positions), *scratch, request);
  }();
  py::list contacts;
  for (const CheckedContact& contact : found) {
    contacts.append(make_result("CheckedContact", checked_body(contact.first),
                                checked_body(contact.second), contact.overlap_depth,
                                contact.padding, array_of(contact.world_point),
                                contact.is_proved_free));
  }
  return py::tuple(contacts);
}

void bind_configurations(py::class_<CheckerOfScene, CheckerPointer>& checker) {
  checker
      .def("check_config", &check_one, py::arg("configuration"),
           Help("check_config(self, configuration)",
                "True if the configuration, shape (dof,), is free: of obstacles and of itself, and "
                "within the limits if these are enforced.")
               .c_str())
      .def("check_configs", &check_many, py::arg("configurations"), py::kw_only(),
           py::arg("threads") = 1,
           Help("check_configs(self, configurations, *, threads=1)",
                "The same of configurations of shape (n, dof): bool, shape (n,). `threads` 0: all "
                "cores.")
               .c_str())
      .def(
          "within", &is_within, py::arg("configuration"), py::arg("clearance"),
          Help(
              "within(self, configuration, clearance)",
              "Whether any two that are tested come within `clearance` (metres) of touching: never "
              "false if they do in exact arithmetic.")
              .c_str())
      .def(
          "clearance", &clearance_of, py::arg("configuration"),
          Help(
              "clearance(self, configuration)",
              "How far the robot is from the nearest contact, between two bounds in metres, and of "
              "which two: a RobotClearance.")
              .c_str())
      .def("clearances", &clearances_of, py::arg("configurations"),
           Help("clearances(self, configurations)",
                "The two bounds for configurations of shape (n, dof): shape (n, 2), metres.")
               .c_str())
      .def("explain", &explained, py::arg("configuration"), py::kw_only(),
           py::arg("max_contacts") = py::none(), py::arg("proved_free") = false,
           Help("explain(self, configuration, *, max_contacts=None, proved_free=False)",
                "What touches what: a tuple of CheckedContact, the deepest for each two bodies. "
                "Empty "
                "exactly if all are free of each other; limits are not looked at. `proved_free`: "
                "tell "
                "of spheres that overlap though their bodies are proved free, too.")
               .c_str());
}

void bind_edges(py::class_<CheckerOfScene, CheckerPointer>& checker) {
  const EdgeRequest defaults;
  checker
      .def(
          "check_edge", &check_one_edge, py::arg("start"), py::arg("end"), py::kw_only(),
          py::arg("resolution") = defaults.resolution, py::arg("first") = defaults.first,
          py::arg("continuous") = "as_given", py::arg("max_configurations") = py::none(),
          Help("check_edge(self, start, end, *, resolution=0.0001, first=False, "
               "continuous='as_given', max_configurations=None)",
               "Whether the straight motion in joint space between two configurations of shape "
               "(dof,) is free at every point of it, proved: an EdgeResult. What comes closer than "
               "about half of `resolution` (metres) need not be proved free. `first`: find the "
               "first "
               "contact. `continuous` joints turn 'as_given' or the 'shortest' way.")
              .c_str())
      .def(
          "check_edges", &check_many_edges, py::arg("start"), py::arg("end"), py::kw_only(),
          py::arg("resolution") = defaults.resolution, py::arg("first") = defaults.first,
          py::arg("continuous") = "as_given", py::arg("max_configurations") = py::none(),
          py::arg("threads") = 1,
          Help(
              "check_edges(self, start, end, *, resolution=0.0001, first=False, "
              "continuous='as_given', max_configurations=None, threads=1)",
              "The same of many, each from start[i] to end[i], of shape (n, dof): EdgeResults. The "
              "edges of a path are check_edges(path[:-1], path[1:]).")
              .c_str())
      .def("measure_edge", &measure_one_edge, py::arg("start"), py::arg("end"), py::kw_only(),
           py::arg("resolution") = defaults.resolution, py::arg("continuous") = "as_given",
           Help("measure_edge(self, start, end, *, resolution=0.0001, continuous='as_given')",
                "How much of the motion is proved free: every point before this fraction is; 1 if "
                "all of it is.")
               .c_str());
}

}  // namespace

CheckerPointer snapshot(const RobotScene& given, bool enforce_limits,
                        const py::object& instructions, const py::object& meshes_in) {
  // Other threads may edit the scene while this one does not hold the lock.
  const RobotScene scene = given;
  const py::tuple meshes(meshes_in);
  RobotCheckerOptions options;
  options.enforce_limits = enforce_limits;
  if (!instructions.is_none()) {
    options.instructions = static_cast<InstructionSet>(
        choice(instructions, {"portable", "avx2", "avx512"}, "instructions"));
  }
  for (const py::handle mesh : meshes) options.meshes.push_back(covered_of(mesh, "meshes"));
  RobotChecker checker = [&] {
    const WithoutLock unlocked;
    return scene.snapshot(options);
  }();
  return std::make_shared<CheckerOfScene>(
      CheckerOfScene{.scene = scene,
                     .options = py::make_tuple(enforce_limits, instructions, meshes),
                     .checker = std::move(checker),
                     .dof = static_cast<std::size_t>(scene.robot().variable_count())});
}

void bind_checker(py::module_& module) {
  py::class_<CheckerOfScene, CheckerPointer> checker(
      module, "RobotChecker",
      "Is a robot free of obstacles and of itself? RobotScene.snapshot() makes it. Immutable; "
      "threads may share it.\n\n\"Free\" means that no two spheres or solids that are tested "
      "against "
      "each other overlap or touch, in exact arithmetic. Configurations are float64 arrays; "
      "radians "
      "and metres.");
  bind_configurations(checker);
  bind_edges(checker);
  checker
      .def_property_readonly("robot",
                             [](const CheckerOfScene& self) {
                               return std::make_shared<RobotModel>(self.scene.robot());
                             })
      .def_readonly("dof", &CheckerOfScene::dof, "How many numbers a configuration has.")
      .def("__repr__",
           [](const CheckerOfScene& self) {
             return "<spherule.RobotChecker: " + std::to_string(self.dof) + " variables, " +
                    std::to_string(self.scene.obstacles().size()) + " obstacles>";
           })
      .def(
          "__copy__",
          [](const CheckerOfScene& self) {
            return std::make_shared<CheckerOfScene>(CheckerOfScene{.scene = self.scene,
                                                                   .options = self.options,
                                                                   .checker = self.checker,
                                                                   .dof = self.dof});
          },
          "Shares all but the memory of queries: what was asked before has no part in its answers.")
      .def(py::pickle(
          [](const CheckerOfScene& self) {
            return py::make_tuple(std::make_shared<RobotScene>(self.scene), self.options);
          },
          [](const py::tuple& state) {
            const auto options = state[1].cast<py::tuple>();
            return snapshot(state[0].cast<const RobotScene&>(), options[0].cast<bool>(), options[1],
                            options[2]);
          }));
}

}  // namespace spherule::python
