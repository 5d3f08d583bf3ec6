// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Collision queries of two placed bodies: sphere trees, meshes with and without their inside,
// covered meshes, point clouds and primitives. "Free" is certain, for exactly the given poses and
// on whole motions. Link spherule::collide, which needs Eigen only.
//
// @code{.cpp}
// #include <spherule/collide.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
// const spherule::SphereTree part = spherule::build_tree(spheres);
// const auto above = spherule::Pose::from_translation({0, 3, 0});
// assert(!spherule::collides(part, {}, part, above));
// assert(spherule::within(part, {}, part, above, 1.5));
// const spherule::DistanceResult gap = spherule::distance(part, {}, part, above);
// assert(gap.lower <= 1.0 && 1.0 <= gap.upper);
// const spherule::Primitive table = spherule::Box{.size = {9, 1, 9}};
// assert(spherule::collides(part, {}, table, spherule::Pose::from_translation({0, -1, 0})));
// @endcode
//
// What is where:
//   spheretree/sphere_tree.h      SphereTree, build_tree(), refit()
//   spheretree/tree_file.h        load_tree(), save_tree()
//   geometry/pose.h               Pose
//   collide/collide.h             two trees: collides(), collide(), within(), distance()
//   collide/contact.h             deepest_contact(): where two bodies touch
//   collide/sweep.h               sweep(): motions; collide/motion/motion.h: what they are
//   collide/pair_cache.h          the same pair again and again
//   collide/point_cloud.h         spheres about measured points
//   collide/meshes/mesh_tree.h    spheres against a surface
//   collide/meshes/solid_mesh.h   a mesh with its inside, as an obstacle
//   collide/meshes/mesh_contact.h  covered meshes: contacts confirmed on the triangles
//   collide/solids/primitive.h    box, sphere, cylinder, capsule, half-space
//   collide/shapes.h              any shape against any: collides() to sweep(), RoundedSolid, Shape
// Covers of meshes by spheres come from spherule/simplifier.h, robots are in spherule/robot.h. What
// is proved: docs/guarantee.md.

#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/motion/motion.h"
#include "collide/pair_cache.h"
#include "collide/point_cloud.h"
#include "collide/shapes.h"
#include "collide/solids/primitive.h"
#include "collide/sweep.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"
