// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "geometry/mesh_distance.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "python/bindings/support.h"

#include <Eigen/Geometry>

#include <string>

namespace spherule::python {
namespace {

using MeshPointer = std::shared_ptr<TriangleMesh>;

MeshPointer made_mesh(const py::object& vertices, const py::object& triangles,
                      double vertex_error) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = points(vertices, "vertices");
  mesh->triangles = triples(triangles, "triangles");
  mesh->vertex_error = vertex_error;
  validate(*mesh, "mesh");
  return mesh;
}

py::array vertices_of(const py::object& self) {
  const auto& mesh = self.cast<const TriangleMesh&>();
  return view(reinterpret_cast<const double*>(mesh.vertices.data()),
              {static_cast<py::ssize_t>(mesh.vertices.size()), 3}, self);
}

py::array triangles_of(const py::object& self) {
  const auto& mesh = self.cast<const TriangleMesh&>();
  return view(reinterpret_cast<const std::int32_t*>(mesh.triangles.data()),
              {static_cast<py::ssize_t>(mesh.triangles.size()), 3}, self);
}

std::string mesh_text(const TriangleMesh& mesh) {
  return "<spherule.TriangleMesh: " + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.triangles.size()) + " triangles>";
}

MeshPointer read_mesh_file(const py::object& path, double scale, double weld) {
  const std::string name = path_of(path, "path");
  return run_long(py::none(), [=](const LongRun&) {
    return std::make_shared<TriangleMesh>(read_mesh(name, {.scale = scale, .weld = weld}));
  });
}

void write_mesh(const py::object& mesh, const py::object& path) {
  const auto kept = mesh_of(mesh, "mesh");
  const std::string name = path_of(path, "path");
  const WithoutLock unlocked;
  write_stl(*kept, name);
}

py::object mesh_report_of(const py::object& mesh, bool self_intersections) {
  const MeshReport r =
      run_long(py::none(), [kept = mesh_of(mesh, "mesh"), self_intersections](const LongRun&) {
        return mesh_report(*kept, {.self_intersections = self_intersections});
      });
  return make_result("MeshReport", r.vertices, r.triangles, r.degenerate_triangles,
                     r.duplicate_triangles, r.boundary_edges, r.non_manifold_edges,
                     r.misoriented_edges, r.components, r.inverted_components, r.self_intersections,
                     r.self_intersections_stopped, r.closed, array_of(r.box), r.area, r.volume,
                     describe(r));
}

// Distances of points to the surface, as two columns: proved bounds.
py::array distances(const py::object& mesh, const py::object& points_in) {
  const auto kept = mesh_of(mesh, "mesh");
  std::vector<Eigen::Vector3d> all = points(points_in, "points");
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_usable_point(all[i])) continue;
    throw Error("points", "row " + std::to_string(i) + " has a number that is not up to 1e15");
  }
  struct Pair {
    double lower, upper;
  };
  auto bounds = run_long(py::none(), [kept, all = std::move(all)](const LongRun&) {
    const MeshDistance distance(*kept);
    std::vector<Pair> result;
    result.reserve(all.size());
    for (const Eigen::Vector3d& point : all) {
      const SurfaceDistance found = distance(point);
      result.push_back({found.lower, found.upper});
    }
    return result;
  });
  return owned<double>(std::move(bounds), 2);
}

void bind_mesh_functions(py::module_& module) {
  module.def(
      "read_mesh", &read_mesh_file, py::arg("path"), py::kw_only(), py::arg("scale") = 1.0,
      py::arg("weld") = 0.0,
      Help("read_mesh(path, *, scale=1.0, weld=0.0)",
           "Reads STL, OBJ, PLY, OFF, DAE, 3MF, glTF or GLB, told apart by the extension.\n\n"
           "`scale` is the factor from the unit of the file to that of the model (1000 turns "
           "metres into millimetres). Vertices no further apart than `weld`, in units of the "
           "model, become one. DAE and glTF come out in metres, 3MF in its own unit.")
          .c_str());
  module.def(
      "write_stl", &write_mesh, py::arg("mesh"), py::arg("path"),
      Help("write_stl(mesh, path)", "Writes binary STL; coordinates are rounded to 32-bit floats.")
          .c_str());
  module.def("mesh_report", &mesh_report_of, py::arg("mesh"), py::kw_only(),
             py::arg("self_intersections") = true,
             Help("mesh_report(mesh, *, self_intersections=True)",
                  "What is unusual about a mesh: a MeshReport. Intersecting pairs of triangles are "
                  "by far the most work to count.")
                 .c_str());
  module.def(
      "mesh_distance", &distances, py::arg("mesh"), py::arg("points"),
      Help("mesh_distance(mesh, points)",
           "Proved bounds of the distances of points, shape (n, 3), to the surface of a mesh: "
           "shape (n, 2), lower and upper.")
          .c_str());
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<TriangleMesh, MeshPointer>(
      module, "TriangleMesh",
      Help("TriangleMesh(vertices, triangles, vertex_error=0.0)",
           "Triangles, with no assumption of watertightness, orientation or freedom from "
           "duplicates. Immutable.\n\n`vertices` has shape (n, 3), `triangles` (m, 3), indices of "
           "vertices. `vertex_error` bounds the distance between a vertex as stored and as meant; "
           "the simplifier adds it to the padding. Functions that take a mesh take the path of a "
           "file and anything with `vertices` and `faces` (trimesh), too.")
          .c_str())
      .def(py::init(&made_mesh), py::arg("vertices"), py::arg("triangles"),
           py::arg("vertex_error") = 0.0)
      .def_property_readonly("vertices", &vertices_of, "Shape (n, 3), float64, read-only, no copy.")
      .def_property_readonly("triangles", &triangles_of, "Shape (m, 3), int32, read-only, no copy.")
      .def_property_readonly("faces", &triangles_of, "The triangles, as trimesh calls them.")
      .def_readonly("vertex_error", &TriangleMesh::vertex_error)
      .def("__repr__", &mesh_text)
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(vertices_of(self), triangles_of(self), self.attr("vertex_error"));
          },
          [](const py::tuple& state) {
            return made_mesh(state[0], state[1], state[2].cast<double>());
          }));
  bind_mesh_functions(module);
}

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
