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
// A transform is checked when it is queried, see from_fcl(). Errors name the argument.
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
#include "adapters/fcl/part_query.h"
#include "adapters/fcl/sphere_model.h"
#include "collide/sweep.h"

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/continuous_collision_request.h>
#include <fcl/narrowphase/continuous_collision_result.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

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

namespace internal {

template <class S>
const CoveredPart& part_of(const fcl::CollisionGeometry<S>* geometry, const char* argument) {
  const auto* model = dynamic_cast<const SphereModel<S>*>(geometry);
  if (model) return model->part();
  throw Error(argument, geometry ? "this geometry has no spheres; sphere_model() makes them"
                                 : "there is no geometry");
}

template <class S>
Pose pose_of(const fcl::Transform3<S>& transform, const char* argument) {
  try {
    return from_fcl(transform);
  } catch (const Error& error) {
    throw Error(argument, error.reason());
  }
}

template <class S>
const fcl::CollisionObject<S>& object(const fcl::CollisionObject<S>* object, const char* argument) {
  if (!object) throw Error(argument, "there is no object");
  return *object;
}

// Not above `value`, if S is coarser.
template <class S>
S rounded_down(double value) {
  const S rounded = static_cast<S>(value);
  const S below = std::nextafter(rounded, -std::numeric_limits<S>::infinity());
  return static_cast<double>(rounded) <= value ? rounded : below;
}

// Adds to the result what is in contact, as long as fewer than `num_max_contacts` are there.
template <class S>
void add_contacts(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
                  const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
                  const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  if (request.num_max_contacts == 0) throw Error("num_max_contacts", "must not be 0");
  if (request.enable_cost) throw Error("enable_cost", "spheres have no cost");
  const PlacedPart a{part_of(o1, "o1"), pose_of<S>(tf1, "tf1")};
  const PlacedPart b{part_of(o2, "o2"), pose_of<S>(tf2, "tf2")};
  if (result.numContacts() >= request.num_max_contacts) return;
  const std::size_t most = request.num_max_contacts - result.numContacts();
  for (const PartContact& found : contacts(a, b, most, request.enable_contact)) {
    fcl::Contact<S> contact;
    contact.o1 = o1;
    contact.o2 = o2;
    contact.b1 = found.b1;
    contact.b2 = found.b2;
    contact.normal = found.normal.template cast<S>();
    contact.pos = found.point.template cast<S>();
    contact.penetration_depth = static_cast<S>(found.depth);
    result.addContact(contact);
  }
}

inline double sweep_resolution(double toc_err) {
  if (!(toc_err > 0.0)) throw Error("toc_err", "must be above zero");
  return std::clamp(toc_err, 0x1p-40, 1.0);
}

// FCL's motion from one transform to another. A turn under CCDM_TRANS, which FCL leaves out, would
// be one that is not checked.
template <class S>
Motion motion(const fcl::Transform3<S>& begin, const fcl::Transform3<S>& end,
              fcl::CCDMotionType type, const char* begin_name, const char* end_name) {
  const Pose first = pose_of<S>(begin, begin_name);
  const Pose last = pose_of<S>(end, end_name);
  if (type == fcl::CCDM_TRANS && !begin.linear().isApprox(end.linear())) {
    throw Error("ccd_motion_type", "CCDM_TRANS leaves out the rotation between " +
                                       std::string(begin_name) + " and " + end_name +
                                       "; CCDM_LINEAR does not");
  }
  if (type != fcl::CCDM_TRANS && type != fcl::CCDM_LINEAR) {
    throw Error("ccd_motion_type", "only CCDM_TRANS and CCDM_LINEAR are supported");
  }
  return Motion::between(first, last);
}

}  // namespace internal

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
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  result.clear();
  internal::add_contacts(o1, tf1, o2, tf2, request, result);
  return result.numContacts();
}

// Whether two objects touch where they stand: collide() of their geometries at their transforms.
template <class S>
std::size_t collide(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  const auto& a = internal::object(o1, "o1");
  const auto& b = internal::object(o2, "o2");
  return fcl_api::collide(a.collisionGeometry().get(), a.getTransform(),
                          b.collisionGeometry().get(), b.getTransform(), request, result);
}

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
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  if (request.enable_signed_distance) {
    throw Error("enable_signed_distance", "is not supported");
  }
  const auto tolerance = static_cast<double>(request.abs_err);
  if (!(tolerance >= 0.0) || !std::isfinite(tolerance)) {
    throw Error("abs_err", "must be finite and not negative");
  }
  const internal::PlacedPart a{internal::part_of(o1, "o1"), internal::pose_of<S>(tf1, "tf1")};
  const internal::PlacedPart b{internal::part_of(o2, "o2"), internal::pose_of<S>(tf2, "tf2")};
  const internal::PartDistance found = internal::distance(a, b, tolerance);
  result.clear();
  result.min_distance =
      found.bounds.lower > 0.0 ? internal::rounded_down<S>(found.bounds.lower) : S(-1);
  result.o1 = o1;
  result.o2 = o2;
  result.b1 = found.bounds.nearest.a;
  result.b2 = found.bounds.nearest.b;
  for (int i = 0; i < 2; ++i) result.nearest_points[i] = found.points[i].template cast<S>();
  return result.min_distance;
}

// The distance of two objects where they stand: distance() of their geometries at their transforms.
template <class S>
S distance(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  const auto& a = internal::object(o1, "o1");
  const auto& b = internal::object(o2, "o2");
  return fcl_api::distance(a.collisionGeometry().get(), a.getTransform(),
                           b.collisionGeometry().get(), b.getTransform(), request, result);
}

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
                    fcl::ContinuousCollisionResult<S>& result) {
  const CoveredPart& a = internal::part_of(o1, "o1");
  const CoveredPart& b = internal::part_of(o2, "o2");
  const auto type = request.ccd_motion_type;
  const Motion motion_a = internal::motion<S>(tf1_beg, tf1_end, type, "tf1_beg", "tf1_end");
  const Motion motion_b = internal::motion<S>(tf2_beg, tf2_end, type, "tf2_beg", "tf2_end");
  const double resolution = internal::sweep_resolution(static_cast<double>(request.toc_err));
  const SweepResult swept =
      sweep(*a.spheres, motion_a, *b.spheres, motion_b, {.resolution = resolution});
  const bool is_free = swept.verdict == Verdict::kFree;
  const double until = is_free ? 1.0 : swept.free_until;
  const double contact_at = swept.verdict == Verdict::kCollision ? swept.contact_at : until;
  result.is_collide = !is_free;
  result.time_of_contact = internal::rounded_down<S>(until);
  result.contact_tf1 = to_fcl<S>(motion_a.pose_at(contact_at));
  result.contact_tf2 = to_fcl<S>(motion_b.pose_at(contact_at));
  return result.time_of_contact;
}

// continuousCollide() of the geometries of two objects, from where they stand to the given ends.
template <class S>
S continuousCollide(const fcl::CollisionObject<S>* o1, const fcl::Transform3<S>& tf1_end,
                    const fcl::CollisionObject<S>* o2, const fcl::Transform3<S>& tf2_end,
                    const fcl::ContinuousCollisionRequest<S>& request,
                    fcl::ContinuousCollisionResult<S>& result) {
  const auto& a = internal::object(o1, "o1");
  const auto& b = internal::object(o2, "o2");
  return fcl_api::continuousCollide(a.collisionGeometry().get(), a.getTransform(), tf1_end,
                                    b.collisionGeometry().get(), b.getTransform(), tf2_end, request,
                                    result);
}

}  // namespace spherule::fcl_api
