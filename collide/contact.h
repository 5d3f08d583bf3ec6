// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where two placed bodies touch, and how deep: for people and planners that want to know more than
// that they do.
//
// @code{.cpp}
// #include <spherule/collide/contact.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// const auto beside = spherule::Pose::from_translation({3.5, 0, 0});
// const auto contact = spherule::deepest_contact(tree, {}, tree, beside);
// assert(contact && contact->leaves.a == 1 && contact->leaves.b == 0);
// assert(contact->penetration_depth > 0.499 && contact->penetration_depth <= 0.5);
// @endcode

#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <optional>

namespace spherule {

// The contact of two sets of spheres: of all pairs of spheres that touch, the one that overlaps
// deepest up to rounding; none exactly if collides() is false. Equal for every tree over the same
// spheres. Allocates. Where bodies overlap it has to examine most of the pairs that collide() would
// list and takes about as long as that, tens to hundreds of times as long as collides().
std::optional<Contact> deepest_contact(const SphereTree& a, const Pose& world_from_a,
                                       const SphereTree& b, const Pose& world_from_b);

// The contact of two covered meshes, the deepest up to rounding: none exactly if their collides()
// is false. Where triangles touch, of all pairs of spheres for which touching_triangles() finds
// some; otherwise, where one lies inside the other, of all pairs of spheres that touch.
std::optional<Contact> deepest_contact(const CoveredMesh& a, const Pose& world_from_a,
                                       const CoveredMesh& b, const Pose& world_from_b);

}  // namespace spherule
