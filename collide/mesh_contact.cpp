// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_contact.h"

#include "collide/meshes/cover_proof.h"
#include "collide/meshes/listed_triangles.h"
#include "collide/meshes/patch_trees.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/box_gap.h"
#include "collide/search/sphere_leaves.h"
#include "collide/search/traversal.h"
#include "spheretree/error.h"

#include <optional>
#include <utility>

namespace spherule {
namespace {

std::shared_ptr<const SphereTree> not_null(std::shared_ptr<const SphereTree> cover) {
  if (!cover) throw Error("cover", "there is none");
  return cover;
}

// Policy of the traversal: ends at the first two spheres whose triangles touch.
class FindTriangles {
 public:
  static constexpr bool kNeedsGaps = false;

  FindTriangles(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                const Pose& world_from_b, const internal::RelativePose& pose)
      : a_(a),
        b_(b),
        world_from_a_(world_from_a),
        world_from_b_(world_from_b),
        pose_(pose),
        spheres_(a.cover(), b.cover(), pose) {}

  bool afford(const internal::OpenedPair&, const auto&) const noexcept { return true; }
  bool leaves(internal::NodePair pair) noexcept {
    if (!spheres_.touches(pair)) return true;
    if (!triangles_) triangles_.emplace(a_, world_from_a_, b_, world_from_b_, pose_);
    found_ = triangles_
                 ->touching(a_.cover().sphere_index(pair.index(0)),
                            b_.cover().sphere_index(pair.index(1)))
                 .has_value();
    return !found_;
  }
  // After the traversal.
  bool found() const { return found_ || (triangles_ && triangles_->contained()); }

 private:
  const CoveredMesh& a_;
  const CoveredMesh& b_;
  const Pose& world_from_a_;
  const Pose& world_from_b_;
  const internal::RelativePose& pose_;
  internal::SphereLeaves spheres_;
  std::optional<internal::ListedTriangles> triangles_;  // once two spheres touch
  bool found_ = false;
};

}  // namespace

CoveredMesh::CoveredMesh(const TriangleMesh& mesh, std::shared_ptr<const SphereTree> cover)
    : cover_(not_null(std::move(cover))), solid_(mesh, 0.0), patches_(share_out()) {}

std::shared_ptr<const internal::PatchTrees> CoveredMesh::share_out() {
  const std::size_t spheres = cover_->spheres().size();
  const std::vector<internal::Patch> patches =
      internal::share_out(solid_.mesh(), cover_->spheres());
  first_.assign(spheres + 1, 0);
  for (const internal::Patch& patch : patches) {
    ++first_[static_cast<std::size_t>(patch.sphere) + 1];
    triangles_.push_back(patch.triangle);
  }
  for (std::size_t i = 0; i < spheres; ++i) first_[i + 1] += first_[i];
  return std::make_shared<const internal::PatchTrees>(patches, cover_->spheres());
}

bool collides(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
              const Pose& world_from_b) noexcept {
  if (internal::far_apart(a.cover(), world_from_a, b.cover(), world_from_b)) return false;
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  if (internal::boxes_apart(a.cover(), b.cover(), pose)) return false;
  FindTriangles query(a, world_from_a, b, world_from_b, pose);
  internal::traverse(a.cover(), b.cover(), pose, query);
  return query.found();
}

std::optional<TrianglePair> touching_triangles(const CoveredMesh& a, std::int32_t sphere_a,
                                               const Pose& world_from_a, const CoveredMesh& b,
                                               std::int32_t sphere_b,
                                               const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose)
      .touching(sphere_a, sphere_b);
}

double contact_depth(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                     const Pose& world_from_b, const TrianglePair& triangles) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose).depth(triangles);
}

double contact_depth(const CoveredMesh& a, std::int32_t triangle_a, const Pose& world_from_a,
                     const SphereTree& b, std::int32_t sphere_b,
                     const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(b, world_from_b, a.mesh().tree(), world_from_a);
  return internal::TriangleLeaves(b, a.mesh(), pose).depth(sphere_b, triangle_a);
}

TriangleDepth nearest_triangle(const CoveredMesh& a, std::int32_t sphere_a,
                               const Pose& world_from_a, const SphereTree& b, std::int32_t sphere_b,
                               const Pose& world_from_b) noexcept {
  const std::span<const Sphere> spheres = a.mesh().tree().spheres();
  const internal::RelativePose pose(b, world_from_b, a.mesh().tree(), world_from_a);
  const Eigen::Vector3d center =
      pose.b_from_a()(b.spheres()[static_cast<std::size_t>(sphere_b)].center);
  TriangleDepth result;
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t triangle : a.triangles_under(sphere_a)) {
    const double square =
        (spheres[static_cast<std::size_t>(triangle)].center - center).squaredNorm();
    if (square >= least) continue;
    least = square;
    result.triangle = triangle;
  }
  if (result.triangle >= 0) {
    result.depth = internal::TriangleLeaves(b, a.mesh(), pose).depth(sphere_b, result.triangle);
  }
  return result;
}

bool contains_component(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                        const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose).contained();
}

}  // namespace spherule
