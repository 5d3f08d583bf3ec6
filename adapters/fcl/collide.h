// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The queries of FCL under FCL's names, answered by spherule. A program that uses fcl::collide()
// goes on with its objects, transforms, requests and results; it gives the objects the geometry
// that sphere_model() makes of each model, and writes spherule::fcl_api for fcl where it is called.
//
// What is requested and not supported is an Error or does not compile. It is never "free".
//
// Where the answers mean more, or other, than FCL's:
// - A result is of the last call only: collide() clears it first. FCL adds to what is there.
// - A model is its triangles and its inside, grown by up to E where the spheres decide. FCL's
//   models are surfaces.
// - None of the functions reads what requests say of FCL's solvers (gjk_*, cached_gjk_guess).
// S is float or double. A transform is checked when it is queried, see from_fcl(). Errors name the
// argument.
//
// @code{.cpp}
// #include <spherule/adapters/fcl/collide.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// namespace api = spherule::fcl_api;
// const auto model = std::make_shared<api::SphereModel<double>>(sphere);
// const api::CollisionObjectd a(model);
// const api::CollisionObjectd b(model, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.15, 0, 0));
// api::CollisionResultd result;
// assert(api::collide(&a, &b, api::CollisionRequestd(), result) == 1);
// @endcode

#include "adapters/fcl/conversions.h"
#include "adapters/fcl/sphere_model.h"

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/continuous_collision_request.h>
#include <fcl/narrowphase/continuous_collision_result.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <cstddef>

namespace spherule::fcl_api {

// So that a program needs one namespace only.
using fcl::CollisionGeometry;
using fcl::CollisionGeometryd;
using fcl::CollisionGeometryf;
using fcl::CollisionObject;
using fcl::CollisionObjectd;
using fcl::CollisionObjectf;
using fcl::CollisionRequest;
using fcl::CollisionRequestd;
using fcl::CollisionRequestf;
using fcl::CollisionResult;
using fcl::CollisionResultd;
using fcl::CollisionResultf;
using fcl::Contact;
using fcl::Contactd;
using fcl::Contactf;
using fcl::ContinuousCollisionRequest;
using fcl::ContinuousCollisionRequestd;
using fcl::ContinuousCollisionRequestf;
using fcl::ContinuousCollisionResult;
using fcl::ContinuousCollisionResultd;
using fcl::ContinuousCollisionResultf;
using fcl::DistanceRequest;
using fcl::DistanceRequestd;
using fcl::DistanceRequestf;
using fcl::DistanceResult;
using fcl::DistanceResultd;
using fcl::DistanceResultf;

// Whether two placed models collide, and where: the number of contacts.
//
// Never 0 if the triangles or the insides of the two models have a point in common (G1, G4). If it
// is not 0, their simplified solids come within E of the one plus E of the other, plus
// collision_slack() (G2, G5). Where both models keep their triangles (ModelOptions), it is not 0
// exactly if collides() of covered meshes says so: what FCL says of the surfaces, or one is inside
// the other, up to rounding.
//
// A contact names two spheres that touch (b1, b2: indices into SphereTree::spheres()), or two
// triangles, where both models keep them; of these, at most one pair for each two spheres is
// listed. Contact::NONE stands for one inside the other. With enable_contact also: a point where
// they touch; the depth by which these two spheres overlap, or contact_depth() of the two
// triangles, which says nothing of how deep the bodies are in each other; and the direction from
// the one sphere's centre to the other's, or the normal of the first triangle.
//
// Throws Error for a missing object, a geometry without spheres, a transform that is none, no
// contacts (num_max_contacts of 0) and costs requested.
template <class S>
std::size_t collide(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
                    const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result);

// Whether two objects touch where they stand: collide() of their geometries at their transforms.
template <class S>
std::size_t collide(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result);

// A lower bound of the distance of two placed models, returned and as min_distance: no two of their
// points are nearer, and of the spheres' distance it falls short by at most abs_err and rounding.
// -1 where the spheres touch, or may for rounding. b1 and b2 are the two nearest spheres, the
// nearest points those of these two. rel_err is not used.
//
// Throws Error as collide() does, for an abs_err that is negative or not finite, and if the signed
// distance is requested.
template <class S>
S distance(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
           const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result);

// The distance of two objects where they stand: distance() of their geometries at their transforms.
template <class S>
S distance(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result);

// Whether two models collide while they move: is_collide is false only if they are proved free at
// every instant (G6, sweep()), never by samples. Otherwise time_of_contact, which is returned, is
// the time up to which they are proved free, at or before the first contact, and contact_tf1 and
// contact_tf2 stand where contact was found or, where it was neither found nor ruled out, at that
// time. The spheres decide, whether or not triangles are kept.
//
// toc_err is the resolution of sweep() (brought into its range); num_max_iterations and the solvers
// are not used. CCDM_LINEAR is Motion::between(): the model's origin goes straight while it turns
// at constant speed. Under CCDM_TRANS, the default, the end must not be turned: FCL leaves such a
// turn out, here it is an Error. So are the other types of motion, and what collide() throws Error
// for.
template <class S>
S continuousCollide(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1_beg,
                    const fcl::Transform3<S>& tf1_end, const fcl::CollisionGeometry<S>* o2,
                    const fcl::Transform3<S>& tf2_beg, const fcl::Transform3<S>& tf2_end,
                    const fcl::ContinuousCollisionRequest<S>& request,
                    fcl::ContinuousCollisionResult<S>& result);

// continuousCollide() of the geometries of two objects, from where they stand to the given ends.
template <class S>
S continuousCollide(const fcl::CollisionObject<S>* o1, const fcl::Transform3<S>& tf1_end,
                    const fcl::CollisionObject<S>* o2, const fcl::Transform3<S>& tf2_end,
                    const fcl::ContinuousCollisionRequest<S>& request,
                    fcl::ContinuousCollisionResult<S>& result);

}  // namespace spherule::fcl_api
