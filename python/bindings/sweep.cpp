// SPDX-License-Identifier: BSD-3-Clause
#include "collide/sweep.h"

#include "collide/motion.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/limits.h"
#include "python/bindings/long_run.h"

namespace spherule::python {
namespace {

// A motion, and how it was made: its class method and the arguments.
struct MadeMotion {
  Motion motion;
  py::tuple recipe;
};

MadeMotion still(const py::object& pose) {
  const Pose at = pose_of(pose, "world_from_body");
  return {Motion::still(at), py::make_tuple("still", at)};
}

MadeMotion between(const py::object& start, const py::object& end, const py::object& reference) {
  const Pose from = pose_of(start, "start");
  const Pose to = pose_of(end, "end");
  const Eigen::Vector3d point = vector3(reference, "reference");
  return {Motion::between(from, to, point), py::make_tuple("between", from, to, array_of(point))};
}

MadeMotion turning(const py::object& start, const py::object& axis, double angle,
                   const py::object& displacement, const py::object& reference) {
  const Pose from = pose_of(start, "start");
  const Eigen::Vector3d about = vector3(axis, "axis");
  const Eigen::Vector3d way = vector3(displacement, "displacement");
  const Eigen::Vector3d point = vector3(reference, "reference");
  return {Motion::turning(from, about, angle, way, point),
          py::make_tuple("turning", from, array_of(about), angle, array_of(way), array_of(point))};
}

MadeMotion remade(const py::tuple& recipe) {
  const std::string kind = py::str(recipe[0]);
  if (kind == "still") return still(recipe[1]);
  if (kind == "between") return between(recipe[1], recipe[2], recipe[3]);
  return turning(recipe[1], recipe[2], recipe[3].cast<double>(), recipe[4], recipe[5]);
}

py::object sweep_of(const SphereTree& a, const MadeMotion& motion_a, const SphereTree& b,
                    const MadeMotion& motion_b, double clearance, double resolution,
                    const py::object& max_node_tests, double max_seconds) {
  const SweepRequest request = {.clearance = clearance,
                                .resolution = resolution,
                                .max_node_tests = count_of(max_node_tests, "max_node_tests"),
                                .max_time = time_of(max_seconds)};
  const SweepResult found = [&] {
    const WithoutLock unlocked;
    return sweep(a, motion_a.motion, b, motion_b.motion, request);
  }();
  return make_result("SweepResult", verdict_of(found.verdict), found.free_until, found.contact_at,
                     py::make_tuple(found.contact.a, found.contact.b), found.evaluations,
                     found.cost.node_tests, found.cost.leaf_tests);
}

std::string motion_text(const MadeMotion& made) {
  const Motion& motion = made.motion;
  return "<spherule.Motion: " + std::string(py::str(made.recipe[0])) + ", turns by " +
         std::string(py::str(py::float_(motion.angle()))) + " rad, goes " +
         std::string(py::str(py::float_(motion.displacement().norm()))) + ">";
}

py::tuple origin() {
  return py::make_tuple(0.0, 0.0, 0.0);
}

void bind_motion(py::module_& module) {
  py::class_<MadeMotion>(
      module, "Motion",
      "A rigid motion over t in [0, 1]: a reference point of the body goes straight at constant "
      "speed, while the body turns about it at constant speed about an axis that is fixed in the "
      "world. Made by still(), between() or turning().")
      .def_static("still", &still, py::arg("world_from_body"),
                  Help("still(world_from_body)", "Stands still.").c_str())
      .def_static("between", &between, py::arg("start"), py::arg("end"),
                  py::arg("reference") = origin(),
                  Help("between(start, end, reference=(0.0, 0.0, 0.0))",
                       "From pose to pose by the shorter way round; `reference` is in the body's "
                       "frame.")
                      .c_str())
      .def_static("turning", &turning, py::arg("start"), py::arg("axis"), py::arg("angle"),
                  py::arg("displacement") = origin(), py::arg("reference") = origin(),
                  Help("turning(start, axis, angle, displacement=(0.0, 0.0, 0.0), "
                       "reference=(0.0, 0.0, 0.0))",
                       "Turns by `angle` (radians) about `axis` (in the world's frame, of any "
                       "length) through the reference point, which moves by `displacement`.")
                      .c_str())
      .def(
          "pose_at", [](const MadeMotion& made, double t) { return made.motion.pose_at(t); },
          py::arg("t"), Help("pose_at(self, t)", "The pose at t, 0 to 1.").c_str())
      .def_property_readonly("angle", [](const MadeMotion& made) { return made.motion.angle(); })
      .def_property_readonly("axis",
                             [](const MadeMotion& made) { return array_of(made.motion.axis()); })
      .def_property_readonly(
          "displacement",
          [](const MadeMotion& made) { return array_of(made.motion.displacement()); })
      .def_property_readonly("start", [](const MadeMotion& made) { return made.motion.start(); })
      .def("__repr__", &motion_text)
      .def(py::pickle([](const MadeMotion& made) { return made.recipe; }, &remade));
}

}  // namespace

py::object verdict_of(Verdict verdict) {
  return result_class("Verdict")(static_cast<int>(verdict));
}

void bind_sweep(py::module_& module) {
  bind_motion(module);
  module.def("sweep", &sweep_of, py::arg("a"), py::arg("motion_a"), py::arg("b"),
             py::arg("motion_b"), py::kw_only(), py::arg("clearance") = 0.0,
             py::arg("resolution") = 1e-4, py::arg("max_node_tests") = py::none(),
             py::arg("max_seconds") = std::numeric_limits<double>::infinity(),
             Help("sweep(a, motion_a, b, motion_b, *, clearance=0.0, resolution=0.0001, "
                  "max_node_tests=None, max_seconds=1e999)",
                  "Whether two SphereTree stay apart while they move: a SweepResult. A motion on "
                  "which they touch, or come within `clearance`, at any t is never called free. "
                  "Intervals of t no longer than `resolution` are not divided any further.")
                 .c_str());
}

}  // namespace spherule::python
