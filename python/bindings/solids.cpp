// SPDX-License-Identifier: BSD-3-Clause
#include "collide/point_cloud.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/bodies.h"
#include "python/bindings/long_run.h"
#include "spheretree/error.h"

#include <array>
#include <map>

namespace spherule::python {
namespace {

using SolidPointer = std::shared_ptr<SolidMesh>;

// With the tree it was made of, which a checker and a pickle need.
struct KeptCoveredMesh : CoveredMesh {
  KeptCoveredMesh(const TriangleMesh& mesh, std::shared_ptr<SphereTree> tree)
      : CoveredMesh(mesh, tree), cover_tree(std::move(tree)) {}
  std::shared_ptr<SphereTree> cover_tree;
};
using CoveredPointer = std::shared_ptr<KeptCoveredMesh>;

SolidPointer made_solid(const py::object& mesh) {
  return run_long(py::none(), [kept = mesh_of(mesh, "mesh")](const LongRun&) {
    return std::make_shared<SolidMesh>(*kept);
  });
}

CoveredPointer made_covered(const py::object& mesh, const std::shared_ptr<SphereTree>& cover) {
  return run_long(py::none(), [kept = mesh_of(mesh, "mesh"), cover](const LongRun&) {
    return std::make_shared<KeptCoveredMesh>(*kept, cover);
  });
}

std::string closed_text(bool is_closed) {
  return is_closed ? "closed" : "not closed";
}

py::object mesh_object(const SolidMesh& solid) {
  return py::cast(std::make_shared<TriangleMesh>(mesh_of(solid)));
}

void bind_meshes(py::module_& module) {
  py::class_<SolidMesh, SolidPointer>(
      module, "SolidMesh",
      Help("SolidMesh(mesh)",
           "A mesh with its inside, as an obstacle: the points within `inflation` (the mesh's "
           "vertex_error) of a triangle or of the inside of a closed surface. Immutable.")
          .c_str())
      .def(py::init(&made_solid), py::arg("mesh"))
      .def_property_readonly("inflation", &SolidMesh::inflation)
      .def_property_readonly("is_closed", &SolidMesh::is_closed,
                             "Whether every triangle is of a closed surface.")
      .def_property_readonly("has_inside", &SolidMesh::has_inside)
      .def("__repr__",
           [](const SolidMesh& solid) {
             return "<spherule.SolidMesh: " + std::to_string(solid.mesh().tree().spheres().size()) +
                    " triangles, " + closed_text(solid.is_closed()) + ">";
           })
      .def(py::pickle(&mesh_object, [](const py::object& mesh) { return made_solid(mesh); }));

  py::class_<KeptCoveredMesh, CoveredPointer>(
      module, "CoveredMesh",
      Help("CoveredMesh(mesh, cover)",
           "A mesh and a SphereTree whose spheres cover it, with the triangles shared out among "
           "them: contacts of spheres are confirmed on triangles. Error where a triangle is not "
           "proved to be covered. Immutable.")
          .c_str())
      .def(py::init(&made_covered), py::arg("mesh"), py::arg("cover"))
      .def_property_readonly(
          "cover", [](const KeptCoveredMesh& mesh) { return mesh.cover_tree; },
          "The tree over the spheres that cover it.")
      .def_property_readonly("is_closed", &KeptCoveredMesh::is_closed)
      .def(py::pickle(
          [](const KeptCoveredMesh& mesh) {
            return py::make_tuple(mesh_object(mesh.solid()), mesh.cover_tree);
          },
          [](const py::tuple& state) {
            return made_covered(state[0], state[1].cast<std::shared_ptr<SphereTree>>());
          }))
      .def("__repr__", [](const KeptCoveredMesh& mesh) {
        return "<spherule.CoveredMesh: " + std::to_string(mesh.mesh().tree().spheres().size()) +
               " triangles under " + std::to_string(mesh.cover().spheres().size()) + " spheres, " +
               closed_text(mesh.is_closed()) + ">";
      });
}

}  // namespace

std::optional<Primitive> primitive_of(py::handle value) {
  const py::handle type = py::type::handle_of(value);
  if (type.is(result_class("Box"))) return Box{vector3(value.attr("size"), "size")};
  if (type.is(result_class("SolidSphere"))) return SolidSphere{number_of(value, "radius")};
  if (type.is(result_class("Cylinder"))) {
    return Cylinder{number_of(value, "radius"), number_of(value, "length")};
  }
  if (type.is(result_class("Capsule"))) {
    return Capsule{number_of(value, "radius"), number_of(value, "length")};
  }
  if (type.is(result_class("HalfSpace"))) return HalfSpace{};
  return std::nullopt;
}

py::object object_of(const Primitive& primitive) {
  if (const auto* box = std::get_if<Box>(&primitive)) {
    return make_result("Box", py::make_tuple(box->size.x(), box->size.y(), box->size.z()));
  }
  if (const auto* ball = std::get_if<SolidSphere>(&primitive)) {
    return make_result("SolidSphere", ball->radius);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&primitive)) {
    return make_result("Cylinder", cylinder->radius, cylinder->length);
  }
  if (const auto* capsule = std::get_if<Capsule>(&primitive)) {
    return make_result("Capsule", capsule->radius, capsule->length);
  }
  return make_result("HalfSpace");
}

Body body_of(py::handle value, const char* name) {
  if (py::isinstance<SphereTree>(value)) return &value.cast<const SphereTree&>();
  if (py::isinstance<SolidMesh>(value)) return &value.cast<const SolidMesh&>();
  if (py::isinstance<KeptCoveredMesh>(value)) return &value.cast<const KeptCoveredMesh&>();
  if (const auto primitive = primitive_of(value)) {
    require_primitive(*primitive, name);
    return *primitive;
  }
  throw py::type_error(std::string(name) +
                       ": it is no SphereTree, SolidMesh, CoveredMesh or primitive");
}

std::shared_ptr<const CoveredMesh> covered_of(py::handle value, const char* name) {
  if (!py::isinstance<KeptCoveredMesh>(value)) {
    throw py::type_error(std::string(name) + ": it is no CoveredMesh");
  }
  return value.cast<CoveredPointer>();
}

TriangleMesh mesh_of(const SolidMesh& solid) {
  TriangleMesh mesh;
  mesh.vertex_error = solid.inflation();
  std::map<std::array<double, 3>, int> known;
  const auto count = static_cast<std::int32_t>(solid.mesh().tree().spheres().size());
  for (std::int32_t i = 0; i < count; ++i) {
    Eigen::Vector3i triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = solid.mesh().triangle(i)[k];
      const auto [entry, is_new] = known.try_emplace({corner.x(), corner.y(), corner.z()},
                                                     static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(corner);
      triangle[static_cast<Eigen::Index>(k)] = entry->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

void bind_solids(py::module_& module) {
  bind_meshes(module);
  module.def(
      "point_cloud_spheres",
      [](const py::object& points_in, double radius, double voxel) {
        return array_of(run_long(
            py::none(), [all = points(points_in, "points"), radius, voxel](const LongRun&) {
              return point_cloud_spheres(all, radius, {.voxel = voxel});
            }));
      },
      py::arg("points"), py::arg("radius"), py::kw_only(), py::arg("voxel") = 0.0,
      Help("point_cloud_spheres(points, radius, *, voxel=0.0)",
           "Spheres, shape (m, 4), that stand for points of shape (n, 3) measured on surfaces: one "
           "of `radius` about every point; with `voxel`, one for the points of each cubic cell of "
           "that side, which contains the spheres of all of them.")
          .c_str());
}

}  // namespace spherule::python
