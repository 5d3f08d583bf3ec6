// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere trees as geometry of FCL.
//
// @code{.cpp}
// #include <spherule/adapters/fcl/sphere_model.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// const spherule::fcl_api::SphereModel<double> model(sphere);
// assert(model.part().spheres->spheres().size() == 1);
// assert(model.aabb_local.max_[0] >= 0.1);
// @endcode

#include "adapters/fcl/conversions.h"
#include "collide/meshes/mesh_contact.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"

#include <fcl/geometry/collision_geometry.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace spherule::fcl_api {

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
  // a pose is within 1e-6 an entry of the matrix (conversions.h): together at most 6 of the
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

}  // namespace spherule::fcl_api
