// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/motion/motion.h"
#include "collide/point_cloud.h"
#include "collide/shapes.h"
#include "collide/sweep.h"
#include "python/bindings/support.h"

#include <array>
#include <map>

// Queries of any two bodies.

namespace spherule::python {
namespace {

const Primitive& content(const Primitive& primitive) {
  return primitive;
}
template <class Kept>
const Kept& content(const Kept* body) {
  return *body;
}

// Two bodies in their places.
struct Placed {
  Body a;
  Pose world_from_a;
  Body b;
  Pose world_from_b;
};

Placed placed(py::handle a, py::handle world_from_a, py::handle b, py::handle world_from_b) {
  return {body_of(a, "a"), pose_of(world_from_a, "world_from_a"), body_of(b, "b"),
          pose_of(world_from_b, "world_from_b")};
}

// The answer of `query`, without the lock.
template <class Answer, class Query>
Answer answer(const Placed& at, const Query& query) {
  return std::visit(
      [&](const auto& a, const auto& b) -> Answer {
        const WithoutLock unlocked;
        return query(content(a), at.world_from_a, content(b), at.world_from_b);
      },
      at.a, at.b);
}

// The call of an overloaded function as a function object, defined exactly where the call is.
#define SPHERULE_QUERY(...)                                                                        \
  [&](const auto& a, const Pose& at_a, const auto& b, const Pose& at_b) -> decltype(__VA_ARGS__) { \
    return __VA_ARGS__;                                                                            \
  }

py::array pairs_of(std::vector<SpherePair> pairs) {
  return owned<std::int32_t>(std::move(pairs), 2);
}

bool collides_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                 const py::object& world_from_b) {
  return answer<bool>(placed(a, world_from_a, b, world_from_b),
                      SPHERULE_QUERY(collides(a, at_a, b, at_b)));
}

py::object collide_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                      const py::object& world_from_b, const py::object& max_pairs,
                      const py::object& max_node_tests, double max_seconds) {
  const CollisionRequest request = {.max_pairs = count_of(max_pairs, "max_pairs"),
                                    .max_node_tests = count_of(max_node_tests, "max_node_tests"),
                                    .max_time = time_of(max_seconds)};
  CollisionResult found = answer<CollisionResult>(
      placed(a, world_from_a, b, world_from_b), SPHERULE_QUERY(collide(a, at_a, b, at_b, request)));
  return make_result("CollisionResult", verdict_of(found.verdict), pairs_of(std::move(found.pairs)),
                     found.complete, found.distance_lower_bound, found.cost.node_tests,
                     found.cost.leaf_tests);
}

bool within_of(const py::object& a, const py::object& world_from_a, const py::object& b,
               const py::object& world_from_b, double clearance) {
  return answer<bool>(placed(a, world_from_a, b, world_from_b),
                      SPHERULE_QUERY(within(a, at_a, b, at_b, clearance)));
}

py::object distance_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                       const py::object& world_from_b, double tolerance, double enough,
                       const py::object& max_node_tests, double max_seconds) {
  const DistanceRequest request = {.tolerance = tolerance,
                                   .enough = enough,
                                   .max_node_tests = count_of(max_node_tests, "max_node_tests"),
                                   .max_time = time_of(max_seconds)};
  const auto found = answer<DistanceResult>(placed(a, world_from_a, b, world_from_b),
                                            SPHERULE_QUERY(distance(a, at_a, b, at_b, request)));
  return make_result("DistanceResult", found.lower, found.upper,
                     py::make_tuple(found.nearest.a, found.nearest.b), found.cost.node_tests,
                     found.cost.leaf_tests);
}

py::object object_of(const Contact& contact) {
  static constexpr const char* kKinds[] = {"spheres", "triangles", "inside"};
  const py::object triangles =
      contact.triangles ? py::object(py::make_tuple(contact.triangles->a, contact.triangles->b))
                        : py::object(py::none());
  return make_result("Contact", kKinds[static_cast<int>(contact.kind)],
                     py::make_tuple(contact.leaves.a, contact.leaves.b), contact.penetration_depth,
                     array_of(contact.position), triangles);
}

py::object deepest_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                      const py::object& world_from_b) {
  const Placed at = placed(a, world_from_a, b, world_from_b);
  const auto found =
      answer<std::optional<Contact>>(at, SPHERULE_QUERY(deepest_contact(a, at_a, b, at_b)));
  if (!found) return py::none();
  const bool is_of_solid =
      std::holds_alternative<const SphereTree*>(at.a) &&
      (std::holds_alternative<const SolidMesh*>(at.b) || std::holds_alternative<Primitive>(at.b));
  if (!is_of_solid) return object_of(*found);
  return make_result("SolidContact", found->leaves.a, found->penetration_depth,
                     array_of(found->position));
}

#undef SPHERULE_QUERY

double slack_of(const SphereTree& a, const py::object& world_from_a, const SphereTree& b,
                const py::object& world_from_b) {
  return collision_slack(a, pose_of(world_from_a, "world_from_a"), b,
                         pose_of(world_from_b, "world_from_b"));
}

template <class Function, class... Extra>
void define(py::module_& module, const char* name, Function function, const Help& help,
            const Extra&... extra) {
  module.def(name, function, py::arg("a"), py::arg("world_from_a"), py::arg("b"),
             py::arg("world_from_b"), extra..., help.c_str());
}

}  // namespace

void bind_queries(py::module_& module) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  define(
      module, "collides", &collides_of,
      Help("collides(a, world_from_a, b, world_from_b)",
           "Whether two bodies, rigidly placed, overlap: never false if they have a point in "
           "common in exact arithmetic.\n\nTwo SphereTree, two CoveredMesh, or a SphereTree and a "
           "SolidMesh, Box, SolidSphere, Cylinder, Capsule or HalfSpace. If it is true, the exact "
           "gap is at most the price of rounding, for two trees collision_slack()."));
  define(module, "collide", &collide_of,
         Help("collide(a, world_from_a, b, world_from_b, *, max_pairs=None, max_node_tests=None, "
              "max_seconds=1e999)",
              "The same test with all pairs of spheres that touch, limits and cost: a "
              "CollisionResult. Two SphereTree, or a SphereTree and a primitive. None: no limit."),
         py::kw_only(), py::arg("max_pairs") = py::none(), py::arg("max_node_tests") = py::none(),
         py::arg("max_seconds") = kInfinity);
  define(module, "within", &within_of,
         Help("within(a, world_from_a, b, world_from_b, clearance)",
              "Whether two bodies come within a clearance of each other, in the unit of the trees: "
              "never false if the exact gap is at most the clearance. The pairs of collides(), and "
              "two SolidMesh, or a SolidMesh and a primitive, but not CoveredMesh."),
         py::arg("clearance"));
  define(
      module, "distance", &distance_of,
      Help("distance(a, world_from_a, b, world_from_b, *, tolerance=0.0, enough=1e999, "
           "max_node_tests=None, max_seconds=1e999)",
           "Separation distance of two bodies between certified bounds: a DistanceResult. It ends "
           "when upper - lower is at most `tolerance`, or lower exceeds `enough`. A SphereTree and "
           "another one, a SolidMesh or a primitive."),
      py::kw_only(), py::arg("tolerance") = 0.0, py::arg("enough") = kInfinity,
      py::arg("max_node_tests") = py::none(), py::arg("max_seconds") = kInfinity);
  define(
      module, "deepest_contact", &deepest_of,
      Help("deepest_contact(a, world_from_a, b, world_from_b)",
           "The contact that overlaps deepest, up to rounding: a Contact, or a SolidContact where "
           "b is a SolidMesh or a primitive; None exactly if collides() is false."));
  define(module, "collision_slack", &slack_of,
         Help("collision_slack(a, world_from_a, b, world_from_b)",
              "Upper bound of the exact gap between two SphereTree for which collides() is true."));
}

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
