// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Narrow phases for FCL's managers.
//
// @code{.cpp}
// #include <spherule/adapters/fcl/broadphase_callback.h>
// #include <spherule/spheretree/build.h>
// #include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// namespace api = spherule::fcl_api;
// const auto model = std::make_shared<api::SphereModel<double>>(sphere);
// api::CollisionObjectd a(model);
// api::CollisionObjectd b(model, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.15, 0, 0));
// fcl::DynamicAABBTreeCollisionManagerd manager;
// manager.registerObjects({&a, &b});
// manager.setup();
// api::DefaultCollisionData<double> query;
// manager.collide(&query, api::DefaultCollisionFunction<double>);
// assert(query.result.isCollision());
// @endcode

#include "adapters/fcl/collide.h"

#include <fcl/broadphase/default_broadphase_callbacks.h>

namespace spherule::fcl_api {

using fcl::DefaultCollisionData;
using fcl::DefaultDistanceData;

// Narrow phases for the managers of fcl::BroadPhaseCollisionManager, to be given to them in the
// place of FCL's functions of the same names, with the same data. The managers cull by the boxes of
// SphereModel, so that what they find is what asking every pair finds. Every object that they hold
// has to be a SphereModel: the first pair with another throws Error, through the manager.
//
// Contacts of all pairs are added to the result until num_max_contacts are there, as FCL does;
// clear it, and `done`, before the next query. Throws Error as collide() does.
template <class S>
bool DefaultCollisionFunction(fcl::CollisionObject<S>* o1, fcl::CollisionObject<S>* o2, void* data);

// The result is that of the pair with the smallest lower bound of its distance so far; it ends at
// the first pair that touches (-1).
template <class S>
bool DefaultDistanceFunction(fcl::CollisionObject<S>* o1, fcl::CollisionObject<S>* o2, void* data,
                             S& dist);

}  // namespace spherule::fcl_api
