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

#include "base/error.h"
#include "collide/meshes/mesh_contact.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"

#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/common/types.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/collision_geometry.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/continuous_collision_request.h>
#include <fcl/narrowphase/continuous_collision_result.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace spherule::fcl_api {

// Transforms and models of FCL as poses and meshes, and back.
//
// @code{.cpp}
// fcl::Transform3d shifted = fcl::Transform3d::Identity();
// shifted.translation() = fcl::Vector3d(1, 2, 3);
// const spherule::Pose pose = spherule::fcl_api::from_fcl(shifted);
// assert(pose.translation() == Eigen::Vector3d(1, 2, 3));
// assert(spherule::fcl_api::to_fcl(pose).isApprox(shifted));
// @endcode

// The pose of a transform of either precision: the rotation nearest to its matrix, up to rounding,
// and its translation. What is queried of the pose is answered for that rotation, from which an
// entry of the matrix differs by at most 1e-6. Throws Error for numbers that are not finite, a
// matrix that is no rotation to within 1e-6 an entry (of R^T R), a reflection, and a translation
// beyond kMaxCoordinate.
template <class S>
Pose from_fcl(const fcl::Transform3<S>& world_from_body) {
  return Pose::from_isometry(world_from_body.template cast<double>());
}

// A pose as FCL has it, rounded to nearest: each entry of the matrix errs by kRotationEntryError,
// in single precision by 2^-24 more.
template <class S = double>
fcl::Transform3<S> to_fcl(const Pose& world_from_body) {
  return world_from_body.isometry().template cast<S>();
}

// The triangles of a model of any bounding volume and either precision, vertex by vertex as FCL
// stores them. Throws Error for a model that is not finished (endModel() comes last), holds points
// only, or that validate() refuses.
template <class BV>
TriangleMesh from_fcl(const fcl::BVHModel<BV>& model) {
  const std::string subject = "FCL model";
  if (model.build_state != fcl::BVH_BUILD_STATE_PROCESSED &&
      model.build_state != fcl::BVH_BUILD_STATE_UPDATED) {
    throw Error(subject, "it is not finished, endModel() has not been called");
  }
  if (model.getModelType() != fcl::BVH_MODEL_TRIANGLES) {
    throw Error(subject, "it has no triangles");
  }
  constexpr auto kNoVertex = static_cast<std::size_t>(std::numeric_limits<int>::max());
  TriangleMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(model.num_vertices));
  for (int i = 0; i < model.num_vertices; ++i) {
    mesh.vertices.push_back(model.vertices[i].template cast<double>());
  }
  mesh.triangles.reserve(static_cast<std::size_t>(model.num_tris));
  for (int i = 0; i < model.num_tris; ++i) {
    const fcl::Triangle& corners = model.tri_indices[i];
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      triangle[k] = static_cast<int>(std::min<std::size_t>(corners[k], kNoVertex));
    }
    mesh.triangles.push_back(triangle);
  }
  validate(mesh, subject);
  return mesh;
}

// Sphere trees as geometry of FCL.
//
// @code{.cpp}
// #include <spherule/spheretree/sphere_tree.h>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// const spherule::fcl_api::SphereModel<double> model(sphere);
// assert(model.part().spheres->spheres().size() == 1);
// assert(model.aabb_local.max_[0] >= 0.1);
// @endcode

// How sphere_model() makes spheres of a model.
struct ModelOptions {
  // Of simplify(): E is `fit.max_error`, in the unit of the model; 0 chooses 1 % of its diagonal.
  SimplifyOptions fit = {};
  // Keep the triangles: contacts of two models that both keep them are decided on these. Otherwise
  // the spheres decide.
  bool confirm_on_triangles = false;
};

// What stands for a part in a query.
struct CoveredPart {
  std::shared_ptr<const SphereTree> spheres;
  // The triangles, if contacts are to be confirmed on them; its cover() is `spheres`.
  std::shared_ptr<const CoveredMesh> mesh = nullptr;
  // What is proved of the spheres, where simplify() made them.
  std::optional<Certificate> certificate = std::nullopt;
};

// Covers a mesh: simplify() and the tree. Throws Error as these do, and with the subject "cover" if
// what was requested is not proved (broken_promises()).
CoveredPart cover_part(const TriangleMesh& mesh, const ModelOptions& options = {});

// A covered part as geometry of FCL: its objects and managers of the broad phase hold it as any
// other, and the functions of this namespace answer for it. Immutable; threads may share it.
//
// The boxes of a part, by which FCL's managers cull, hold its spheres wherever the body is at most
// 100 times SphereTree::reach() away from the origin of the world. Beyond, FCL's own rounding of a
// box counts.
//
// FCL's own collide() and distance() do not know spheres and would answer "free" for lack of a
// function. So getObjectType(), which they call first, throws Error; so do FCL's managers with
// FCL's narrow phases, and its continuousCollide() with the default solver. With
// CCDC_CONSERVATIVE_ADVANCEMENT, or another solver and a geometry of FCL's, that one examines
// nothing but getNodeType(), which managers call, too, so that it cannot throw: FCL prints a
// warning, returns -1 and may leave is_collide false.
template <class S>
class SphereModel final : public fcl::CollisionGeometry<S> {
 public:
  // Throws Error without spheres, for a tree that was moved from, and for a mesh with another
  // cover.
  explicit SphereModel(CoveredPart part) : part_(std::move(part)) {
    if (!part_.spheres) throw Error("sphere model", "there are no spheres");
    if (part_.mesh && &part_.mesh->cover() != part_.spheres.get()) {
      throw Error("sphere model", "the mesh is covered by other spheres");
    }
    place_box();
  }
  explicit SphereModel(std::shared_ptr<const SphereTree> spheres)
      : SphereModel(CoveredPart{.spheres = std::move(spheres)}) {}

  // What the queries of spherule::fcl_api use.
  const CoveredPart& part() const { return part_; }

  // Done when made: FCL calls it for every object.
  void computeLocalAABB() override {}

  // Throws Error: with it FCL's own queries would take the model for free.
  fcl::OBJECT_TYPE getObjectType() const override {
    throw Error("sphere model",
                "FCL's own queries do not know it; query those of spherule::fcl_api");
  }

 private:
  // FCL takes a rotation whose entries are within dummy_precision() of the identity's for none, and
  // a pose is within 1e-6 an entry of the matrix (from_fcl()): together at most 6 of the
  // tolerance below times the reach. To move a box to |T| costs some 10 roundings of |T| + 2 reach:
  // for 100 reaches 1e-13 of the reach in double, 6.2e-5 in single precision, 6.2 tolerances.
  void place_box() {
    const double tolerance =
        std::max(1e-6, static_cast<double>(Eigen::NumTraits<S>::dummy_precision()));
    const double slack = 16.0 * tolerance * part_.spheres->reach();
    const auto& box = part_.spheres->box();
    const Eigen::Vector3d half = box.half_size.array() + slack;
    this->aabb_center = box.center.template cast<S>();
    this->aabb_radius = static_cast<S>(half.norm());
    this->aabb_local = fcl::AABB<S>((box.center - half).template cast<S>().eval(),
                                    (box.center + half).template cast<S>().eval());
  }

  CoveredPart part_;
};

using SphereModelf = SphereModel<float>;   // in single precision
using SphereModeld = SphereModel<double>;  // in double precision

// From a model of FCL to one that stands for it in the queries of this namespace, in one call.
// Throws Error as from_fcl() and cover_part() do.
template <class BV>
std::shared_ptr<SphereModel<typename BV::S>> sphere_model(const fcl::BVHModel<BV>& model,
                                                          const ModelOptions& options = {}) {
  return std::make_shared<SphereModel<typename BV::S>>(cover_part(from_fcl(model), options));
}

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

// Narrow phases for FCL's managers.
//
// @code{.cpp}
// #include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
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
