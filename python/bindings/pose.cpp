// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/pose.h"

#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "spheretree/error.h"

#include <Eigen/Geometry>

namespace spherule::python {
namespace {

Pose made_pose(const py::object& translation, const py::object& rotation) {
  const Numbers turn = row(rotation, 4, "rotation");
  const double* const q = turn.data;
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), vector3(translation, "translation")};
}

py::array rotation_of(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  return array_of(Sphere{{q.x(), q.y(), q.z()}, q.w()});
}

py::array pose_matrix(const Pose& pose) {
  using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  py::array_t<double> array({4, 4});
  Eigen::Map<Rows>(array.mutable_data()) = pose.isometry().matrix();
  return array;
}

py::object product(const Pose& pose, const py::object& other) {
  if (py::isinstance<Pose>(other)) return py::cast(pose * other.cast<const Pose&>());
  const Numbers all = numbers(other, "points");
  if (all.array.ndim() == 1) return array_of(pose * vector3(other, "points"));
  std::vector<Eigen::Vector3d> moved = points(other, "points");
  for (Eigen::Vector3d& point : moved) point = pose * point;
  return array_of(std::move(moved));
}

std::string pose_text(const Pose& pose) {
  return "Pose(translation=" + std::string(py::str(array_of(pose.translation()).attr("tolist")())) +
         ", rotation=" + std::string(py::str(rotation_of(pose).attr("tolist")())) + ")";
}

}  // namespace

void bind_pose(py::module_& module) {
  py::class_<Pose>(module, "Pose",
                   Help("Pose(translation=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0, 1.0))",
                        "A rigid motion, named target_from_source: it maps a point given in the "
                        "source frame to the target frame.\n\n`translation` has shape (3,), "
                        "`rotation` is a quaternion x, y, z, w, of any length but 0; both are "
                        "stored as given. Immutable. Functions that take a pose take a matrix of "
                        "shape (4, 4), too, and None for the identity.")
                       .c_str())
      .def(py::init(&made_pose), py::arg("translation") = py::make_tuple(0.0, 0.0, 0.0),
           py::arg("rotation") = py::make_tuple(0.0, 0.0, 0.0, 1.0))
      .def_static(
          "from_isometry", [](const py::object& matrix) { return pose_of(matrix, "matrix"); },
          py::arg("matrix"),
          Help("from_isometry(matrix)",
               "Of a matrix of shape (4, 4), whose linear part must be a rotation to within 1e-6 "
               "an entry; the nearest one is taken.")
              .c_str())
      .def_static(
          "from_translation",
          [](const py::object& translation) {
            return Pose::from_translation(vector3(translation, "translation"));
          },
          py::arg("translation"),
          Help("from_translation(translation)", "A shift without a turn; shape (3,).").c_str())
      .def_property_readonly("translation",
                             [](const Pose& pose) { return array_of(pose.translation()); })
      .def_property_readonly("rotation", &rotation_of)
      .def_property_readonly("matrix", &pose_matrix)
      .def("inverse", &Pose::inverse, Help("inverse(self)", "The motion back, rounded.").c_str())
      .def("__mul__", &product, py::arg("other"), py::is_operator(),
           Help("__mul__(self, other, /)",
                "The composition with another Pose, or points of shape (3,) or (n, 3), mapped.")
               .c_str())
      .def("__matmul__", &product, py::arg("other"), py::is_operator(),
           Help("__matmul__(self, other, /)", "As the product.").c_str())
      .def("__eq__",
           [](const Pose& a, const py::object& other) {
             if (!py::isinstance<Pose>(other)) return false;
             const Pose& b = other.cast<const Pose&>();
             return a.rotation().coeffs() == b.rotation().coeffs() &&
                    a.translation() == b.translation();
           })
      .def("__repr__", &pose_text)
      .def(py::pickle(
          [](const Pose& pose) {
            return py::make_tuple(array_of(pose.translation()), rotation_of(pose));
          },
          [](const py::tuple& state) { return made_pose(state[0], state[1]); }));
}

}  // namespace spherule::python
