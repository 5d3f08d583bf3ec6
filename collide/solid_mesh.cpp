// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solid_mesh.h"

#include "collide/meshes/mesh_search.h"
#include "collide/search/one_tree.h"
#include "collide/search/sphere_space.h"
#include "collide/solids/mesh_inside.h"
#include "collide/solids/node_boxes.h"
#include "collide/solids/spheres_inside.h"
#include "collide/within.h"
#include "mesh/point_triangle.h"

#include <algorithm>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::GapInterval;
using internal::SpheresInside;

// With a clearance, growth included. Where no sphere comes so near to a triangle, none intersects
// one, and each is on one side of the surface.
bool comes_within(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
                  const Pose& world_from_solid, double clearance) noexcept {
  const double reach = clearance > 0.0 ? add_up(clearance, solid.inflation()) : solid.inflation();
  if (internal::collides_by(internal::best_mesh_kernel(), tree, world_from_tree, solid.mesh(),
                            world_from_solid, reach)) {
    return true;
  }
  if (!solid.has_inside()) return false;
  const internal::RelativePose pose(tree, world_from_tree, solid.mesh().tree(), world_from_solid);
  return SpheresInside(tree, solid, pose).find() >= 0;
}

// Of a point, given in the mesh's frame, to the spheres of its tree and to its triangles: what
// SphereSpace requires.
class PointGaps {
 public:
  PointGaps(const MeshTree& mesh, const Vector3d& point) : mesh_(mesh), point_(point) {}

  double gap(const Sphere& sphere) const { return (sphere.center - point_).norm() - sphere.radius; }
  TriangleDistance to_triangle(std::int32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangle(triangle);
    return point_triangle_distance(point_, a, b, c);
  }
  GapInterval leaf_gap(std::int32_t triangle) const {
    const TriangleDistance found = to_triangle(triangle);
    return {found.lower, found.upper};
  }

 private:
  const MeshTree& mesh_;
  const Vector3d point_;
};

// Of all spheres that may touch the solid, the one that is deepest in it.
//
// A point of the solid's boundary is at most inflation() from the surface, so that a sphere whose
// centre is inside has to move by its radius, inflation() and the centre's distance from the
// surface, and one whose centre is not by the radius and inflation() less that distance. The
// distance is that of the centre's image, off by error(); what NearestFirst adds for its own
// roundings is counted in.
class FindDeepest {
 public:
  FindDeepest(const SphereTree& tree, const SolidMesh& solid, const SpheresInside& spheres)
      : tree_(tree), solid_(solid), spheres_(spheres) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    const Sphere sphere = tree_.sphere(static_cast<std::size_t>(node));
    const Vector3d center = spheres_.in_mesh(sphere.center);
    const double reach = add_up(sphere.radius, solid_.inflation());
    return !spheres_.is_clear(center, reach) || spheres_.contains(center);
  }
  bool leaf(std::int32_t node) {
    const auto index = static_cast<std::size_t>(node);
    const Sphere sphere = tree_.sphere(index);
    const Vector3d center = spheres_.in_mesh(sphere.center);
    const PointGaps gaps(solid_.mesh(), center);
    const internal::SphereSpace space(solid_.mesh().tree(), gaps);
    const DistanceResult to_surface =
        internal::NearestFirst(space, spheres_.error(), DistanceRequest{}).run(0, space.gap(0));
    const bool inside = spheres_.certainly_contains(center);
    const double reach = sub_down(add_down(sphere.radius, solid_.inflation()), spheres_.error());
    const double depth =
        inside ? add_down(reach, to_surface.lower) : sub_down(reach, to_surface.upper);
    const std::int32_t leaf = tree_.sphere_index(index);
    if (sphere_ >= 0 && (depth < depth_ || (depth == depth_ && leaf > sphere_))) return true;
    depth_ = depth;
    sphere_ = leaf;
    in_mesh_ = inside ? center : gaps.to_triangle(to_surface.nearest.a).closest;
    return true;
  }
  std::int32_t sphere() const { return sphere_; }
  double depth() const { return depth_; }
  const Vector3d& in_mesh() const { return in_mesh_; }

 private:
  const SphereTree& tree_;
  const SolidMesh& solid_;
  const SpheresInside& spheres_;
  std::int32_t sphere_ = -1;
  double depth_ = 0.0;
  Vector3d in_mesh_ = Vector3d::Zero();
};

}  // namespace

SolidMesh::SolidMesh(const TriangleMesh& mesh) : SolidMesh(mesh, mesh.vertex_error) {}

SolidMesh::SolidMesh(const TriangleMesh& mesh, double inflation)
    : mesh_(mesh),
      inflation_(inflation),
      inside_(std::make_shared<const internal::MeshInside>(mesh)),
      node_boxes_(std::make_shared<const internal::NodeBoxes>(mesh_)) {}

bool SolidMesh::is_closed() const {
  return inside_->is_closed();
}

bool SolidMesh::has_inside() const {
  return inside_->has_inside();
}

bool collides(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
              const Pose& world_from_solid) noexcept {
  return comes_within(tree, world_from_tree, solid, world_from_solid, 0.0);
}

bool within(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
            const Pose& world_from_solid, double clearance) {
  require_clearance(clearance);
  return comes_within(tree, world_from_tree, solid, world_from_solid, clearance);
}

DistanceResult distance(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
                        const Pose& world_from_solid, const DistanceRequest& request) {
  DistanceRequest to_surface = request;
  to_surface.enough = add_up(request.enough, solid.inflation());
  DistanceResult result =
      distance(tree, world_from_tree, solid.mesh(), world_from_solid, to_surface);
  result.upper = result.upper > solid.inflation() ? sub_up(result.upper, solid.inflation()) : 0.0;
  // Where a sphere may intersect a triangle, the lower bound is 0 and the upper one as good as it
  // gets.
  if (!(result.lower > 0.0)) return result;
  const internal::RelativePose pose(tree, world_from_tree, solid.mesh().tree(), world_from_solid);
  const SpheresInside spheres(tree, solid, pose);
  const std::int32_t inside = spheres.find();
  if (inside >= 0) {
    result.lower = 0.0;
    const Vector3d& center = tree.spheres()[static_cast<std::size_t>(inside)].center;
    if (spheres.certainly_contains(spheres.in_mesh(center))) {
      result.upper = 0.0;
      result.nearest = {inside, -1};
    }
  } else {
    result.lower = std::max(0.0, sub_down(result.lower, solid.inflation()));
  }
  return result;
}

std::optional<SolidContact> deepest_contact(const SphereTree& tree, const Pose& world_from_tree,
                                            const SolidMesh& solid, const Pose& world_from_solid) {
  if (!collides(tree, world_from_tree, solid, world_from_solid)) return std::nullopt;
  const internal::RelativePose pose(tree, world_from_tree, solid.mesh().tree(), world_from_solid);
  const SpheresInside spheres(tree, solid, pose);
  FindDeepest query(tree, solid, spheres);
  internal::search_tree(tree, query);
  return SolidContact{query.sphere(), query.depth(), world_from_solid * query.in_mesh()};
}

}  // namespace spherule
