// SPDX-License-Identifier: BSD-3-Clause
// Queries of two bodies. Which pairs there are, the overloads of the library say.

#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/distance.h"
#include "collide/solid_within.h"
#include "collide/within.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/bodies.h"
#include "python/bindings/limits.h"
#include "python/bindings/long_run.h"

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

// The answer of `query`, without the lock, for two bodies that the library has it for.
template <class Answer, class Query>
Answer answer(const Placed& at, const char* name, const Query& query) {
  return std::visit(
      [&](const auto& a, const auto& b) -> Answer {
        if constexpr (requires {
                        query(content(a), at.world_from_a, content(b), at.world_from_b);
                      }) {
          const WithoutLock unlocked;
          return query(content(a), at.world_from_a, content(b), at.world_from_b);
        } else {
          throw py::type_error(std::string(name) +
                               ": there is no such query of these two kinds of bodies");
        }
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
  return answer<bool>(placed(a, world_from_a, b, world_from_b), "collides",
                      SPHERULE_QUERY(collides(a, at_a, b, at_b)));
}

py::object collide_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                      const py::object& world_from_b, const py::object& max_pairs,
                      const py::object& max_node_tests, double max_seconds) {
  const CollisionRequest request = {.max_pairs = count_of(max_pairs, "max_pairs"),
                                    .max_node_tests = count_of(max_node_tests, "max_node_tests"),
                                    .max_time = time_of(max_seconds)};
  CollisionResult found =
      answer<CollisionResult>(placed(a, world_from_a, b, world_from_b), "collide",
                              SPHERULE_QUERY(collide(a, at_a, b, at_b, request)));
  return make_result("CollisionResult", verdict_of(found.verdict), pairs_of(std::move(found.pairs)),
                     found.complete, found.distance_lower_bound, found.cost.node_tests,
                     found.cost.leaf_tests);
}

bool within_of(const py::object& a, const py::object& world_from_a, const py::object& b,
               const py::object& world_from_b, double clearance) {
  return answer<bool>(placed(a, world_from_a, b, world_from_b), "within",
                      SPHERULE_QUERY(within(a, at_a, b, at_b, clearance)));
}

py::object distance_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                       const py::object& world_from_b, double tolerance, double enough,
                       const py::object& max_node_tests, double max_seconds) {
  const DistanceRequest request = {.tolerance = tolerance,
                                   .enough = enough,
                                   .max_node_tests = count_of(max_node_tests, "max_node_tests"),
                                   .max_time = time_of(max_seconds)};
  const auto found = answer<DistanceResult>(placed(a, world_from_a, b, world_from_b), "distance",
                                            SPHERULE_QUERY(distance(a, at_a, b, at_b, request)));
  return make_result("DistanceResult", found.lower, found.upper,
                     py::make_tuple(found.nearest.a, found.nearest.b), found.cost.node_tests,
                     found.cost.leaf_tests);
}

py::object object_of(const std::optional<Contact>& contact) {
  if (!contact) return py::none();
  static constexpr const char* kKinds[] = {"spheres", "triangles", "inside"};
  const py::object triangles =
      contact->triangles ? py::object(py::make_tuple(contact->triangles->a, contact->triangles->b))
                         : py::object(py::none());
  return make_result("Contact", kKinds[static_cast<int>(contact->kind)],
                     py::make_tuple(contact->spheres.a, contact->spheres.b), contact->overlap_depth,
                     array_of(contact->world_point), triangles);
}

py::object object_of(const std::optional<SolidContact>& contact) {
  if (!contact) return py::none();
  return make_result("SolidContact", contact->sphere, contact->overlap_depth,
                     array_of(contact->world_point));
}

using AnyContact = std::variant<std::optional<Contact>, std::optional<SolidContact>>;

py::object deepest_of(const py::object& a, const py::object& world_from_a, const py::object& b,
                      const py::object& world_from_b) {
  const auto found = answer<AnyContact>(placed(a, world_from_a, b, world_from_b), "deepest_contact",
                                        SPHERULE_QUERY(deepest_contact(a, at_a, b, at_b)));
  return std::visit([](const auto& contact) { return object_of(contact); }, found);
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

}  // namespace spherule::python
