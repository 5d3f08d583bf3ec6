// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/mesh_io.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_report.h"
#include "mesh/triangle_mesh.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/long_run.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

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

}  // namespace spherule::python
