// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Any shape against any: sphere trees, surface meshes, meshes with their inside, covered meshes and
// solids with or without a rounding.
//
// @code{.cpp}
// #include <spherule/collide/shapes.h>
// #include <cassert>
// //
// const spherule::RoundedSolid tool{spherule::Box{.size = {1, 1, 1}}, 0.25};
// const spherule::Cylinder post{.radius = 0.5, .length = 2};
// const auto beside = spherule::Pose::from_translation({1.5, 0, 0});
// assert(!collides(tool, {}, post, beside));
// assert(within(tool, {}, post, beside, 0.25));
// const spherule::DistanceResult gap = distance(tool, {}, post, beside);
// assert(gap.lower <= 0.25 && 0.25 <= gap.upper && gap.upper - gap.lower < 1e-9);
// const auto into = spherule::Pose::from_translation({1.125, 0, 0});
// const std::optional<spherule::Contact> contact = deepest_contact(tool, {}, post, into);
// assert(contact && contact->penetration_depth <= 0.125 && contact->normal.x() > 0.999);
// @endcode

#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/solids/primitive.h"
#include "collide/sweep.h"

#include <concepts>
#include <memory>
#include <optional>
#include <variant>

namespace spherule {

// The points within `rounding` of a solid. `core` must be one that require_primitive() accepts.
struct RoundedSolid {
  Primitive core;
  double rounding = 0.0;  // from 0 to kMaxCoordinate
};

// A shape that is chosen when the program runs. None of the pointers may be null.
using Shape = std::variant<std::shared_ptr<const SphereTree>, std::shared_ptr<const MeshTree>,
                           std::shared_ptr<const SolidMesh>, std::shared_ptr<const CoveredMesh>,
                           RoundedSolid>;

// What the functions below take: a SphereTree, MeshTree, SolidMesh, CoveredMesh, Box, SolidSphere,
// Cylinder, Capsule, HalfSpace, Primitive, RoundedSolid or Shape. Refers to trees and meshes.
class ShapeRef {
 public:
  // What it refers to; a solid is held itself.
  using Alternatives = std::variant<const SphereTree*, const MeshTree*, const SolidMesh*,
                                    const CoveredMesh*, RoundedSolid>;

  // Each of the kinds above. Trees and meshes must outlive it.
  ShapeRef(const SphereTree& tree) : shape_(&tree) {}
  ShapeRef(const MeshTree& surface) : shape_(&surface) {}
  ShapeRef(const SolidMesh& solid) : shape_(&solid) {}
  ShapeRef(const CoveredMesh& mesh) : shape_(&mesh) {}
  ShapeRef(const RoundedSolid& solid) : shape_(solid) {}
  // A Primitive or one of its kinds, without a rounding.
  template <class Solid>
  requires std::constructible_from<Primitive, const Solid&> ShapeRef(const Solid& solid)
      : shape_(RoundedSolid{Primitive(solid), 0.0}) {}
  // Of what the pointer leads to.
  ShapeRef(const Shape& shape);

  // The shape, for a visitor.
  const Alternatives& get() const { return shape_; }

 private:
  Alternatives shape_;
};

// The queries of any two shapes a and b, rigidly placed. A shape consists of leaves, with or
// without an inside: the spheres of a tree, the triangles of a mesh, one solid. SolidMesh and
// CoveredMesh have an inside; whatever is wholly inside touches it, at the distance 0. A
// CoveredMesh is its solid(), except against another one. SolidMesh::inflation() and `rounding`
// count.
//
// Where a function for two types has the same name (collide.h, mesh_tree.h, solid_mesh.h,
// primitive.h, mesh_contact.h), a call with these types, in either order, gives its answer, with
// its guarantees. What follows is about all others. Of two half-spaces nothing but "they touch" is
// answered, though parallel ones may not.
//
// All bounds are proved for exact arithmetic under exactly the given poses
// (collide/solids/convex.h). Those of two leaves are as near to each other as the search for their
// nearest points comes: in our tests mostly within 1e-10 of the scene, with a cylinder within 4e-6.
// This is what the word "slack" stands for here; there is no bound in advance. Poses that
// differ by a swap of a and b may give answers that differ within the slack.
//
// All may allocate. They throw Error for a rounding that is out of range, for a half-space that is
// 2e14 or farther from the other shape, and as require_clearance()
// and, in sweep(), as the function for two trees does.

// Whether they have a point in common. Never false if they have. If it is true, they come within
// the slack.
bool collides(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
              const Pose& world_from_b);

// Whether they come within a clearance (a security margin) of each other: never false if the exact
// distance is at most the clearance, never true if it exceeds it by more than the slack.
bool within(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
            const Pose& world_from_b, double clearance);

// The pairs of leaves that touch, up to the limits requested. Where one shape is inside the other
// and no leaves touch, the verdict is kCollision, without any pair.
CollisionResult collide(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
                        const Pose& world_from_b, const CollisionRequest& request = {});

// Their distance between certified bounds: `lower` never above, `upper` never below. Where leaves
// touch, `lower` is 0 and `upper` at most the slack. Where one shape is inside the other, both are
// 0 and `nearest` has no pair (-1).
DistanceResult distance(const ShapeRef& a, const Pose& world_from_a, const ShapeRef& b,
                        const Pose& world_from_b, const DistanceRequest& request = {});

// A contact; none exactly if collides() is false. Of all pairs of leaves that touch, the one that
// overlaps deepest up to rounding, by the proved depth (for curved solids up to a few per cent).
std::optional<Contact> deepest_contact(const ShapeRef& a, const Pose& world_from_a,
                                       const ShapeRef& b, const Pose& world_from_b);

// Whether they stay apart while they move (G6). kFree: at every t in [0, 1] they are farther apart
// than the clearance, in exact arithmetic under exactly the motions. kCollision: within() says yes
// at pose_at(contact_at) of both. `contact` is the pair nearest there, as distance() has it.
SweepResult sweep(const ShapeRef& a, const Motion& motion_a, const ShapeRef& b,
                  const Motion& motion_b, const SweepRequest& request = {});

namespace internal {

// What a shape may reach: all of it lies in the sphere, in its frame, if it is bounded.
struct Extent {
  Sphere around;
  bool is_bounded;
};
Extent extent_of(const ShapeRef& shape);

}  // namespace internal

}  // namespace spherule
