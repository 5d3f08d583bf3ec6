// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/solid_mesh.h"

#include "base/rounding.h"
#include "collide/meshes/mesh_inside.h"
#include "collide/meshes/mesh_search.h"
#include "collide/meshes/spheres_inside.h"
#include "collide/search/nearest_first.h"
#include "collide/search/query.h"
#include "collide/search/traversal.h"
#include "collide/solids/convex.h"
#include "geometry/point_triangle.h"
#include "spheretree/build.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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
    if (sphere_ >= 0 && (depth < contact_.depth || (depth == contact_.depth && leaf > sphere_)))
      return true;
    sphere_ = leaf;
    const Vector3d nearest = gaps.to_triangle(to_surface.nearest.a).closest;
    const Vector3d way = inside ? center - nearest : nearest - center;
    contact_.depth = depth;
    if (way.norm() > 0.0) contact_.normal = way.normalized();
    contact_.on_a = center + sphere.radius * contact_.normal;
    contact_.on_b = nearest - solid_.inflation() * contact_.normal;
    contact_.common = inside ? center : nearest;
    return true;
  }
  std::int32_t sphere() const { return sphere_; }
  // In the mesh's frame.
  const internal::ConvexContact& contact() const { return contact_; }

 private:
  const SphereTree& tree_;
  const SolidMesh& solid_;
  const SpheresInside& spheres_;
  std::int32_t sphere_ = -1;
  internal::ConvexContact contact_;
};

}  // namespace

SolidMesh::SolidMesh(const TriangleMesh& mesh) : SolidMesh(mesh, mesh.vertex_error) {}

SolidMesh::SolidMesh(const TriangleMesh& mesh, double inflation)
    : mesh_(mesh),
      inflation_(inflation),
      inside_(std::make_shared<const internal::MeshInside>(mesh)) {}

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

std::optional<Contact> deepest_contact(const SphereTree& tree, const Pose& world_from_tree,
                                       const SolidMesh& solid, const Pose& world_from_solid) {
  if (!collides(tree, world_from_tree, solid, world_from_solid)) return std::nullopt;
  const internal::RelativePose pose(tree, world_from_tree, solid.mesh().tree(), world_from_solid);
  const SpheresInside spheres(tree, solid, pose);
  FindDeepest query(tree, solid, spheres);
  internal::search_tree(tree, query);
  return internal::placed_contact({query.sphere(), -1}, query.contact(), world_from_solid);
}

}  // namespace spherule

namespace spherule::internal {
namespace {

// Numbers below the least normal one are not used, so that boxes hold their triangles also where a
// processor takes such numbers for zero.
constexpr float kLeastNormal = std::numeric_limits<float>::min();

float rounded_or_zero(double value) {
  return std::abs(value) < static_cast<double>(kLeastNormal) ? 0.0F : static_cast<float>(value);
}

// The next float above the one to which `value` is rounded, in whatever direction.
float up_to_float(double value) {
  return std::max(std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()),
                  kLeastNormal);
}

}  // namespace

NodeBoxes::NodeBoxes(const MeshTree& mesh) {
  const SphereTree& tree = mesh.tree();
  std::vector<Eigen::AlignedBox3d> boxes(tree.node_count());
  boxes_.resize(boxes.size());
  // Children come after their parents.
  for (std::size_t node = boxes.size(); node-- > 0;) {
    Eigen::AlignedBox3d& box = boxes[node];
    if (tree.is_leaf(node)) {
      for (const Eigen::Vector3d& corner : mesh.triangle(tree.sphere_index(node))) {
        box.extend(corner);
      }
    }
    for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
      box.extend(boxes[static_cast<std::size_t>(tree.first_child(node) + i)]);
    }
    for (int i = 0; i < 3; ++i) {
      const float center = rounded_or_zero(0.5 * box.min()[i] + 0.5 * box.max()[i]);
      boxes_[node].center[i] = center;
      boxes_[node].half_size[i] =
          up_to_float(std::max(sub_up(box.max()[i], center), sub_up(center, box.min()[i])));
    }
  }
}

AxisAlignedBox NodeBoxes::box(std::size_t node) const {
  const Stored& stored = boxes_[node];
  return {{stored.center[0], stored.center[1], stored.center[2]},
          {stored.half_size[0], stored.half_size[1], stored.half_size[2]}};
}

namespace {

using Eigen::Vector3d;

// Cells at the surface are split down to this part of the mean radius of the triangles' spheres, as
// long as there are not more of them than so many for each triangle.
constexpr double kSmallestCell = 1.0;
constexpr std::size_t kCellsATriangle = 4;
constexpr std::size_t kFewestCells = 512;
constexpr int kMostLevels = 12;

struct Cell {
  Vector3d center;
  double half;

  // Halves are powers of two of the first one, but centres err by a few units in the last place.
  Sphere sphere() const {
    return {center, half * 1.7320508075688774 * (1.0 + 1e-9) + 1e-14 * center.cwiseAbs().sum()};
  }
};

// Whether the sphere around one triangle holds all of another sphere.
class FindHolder {
 public:
  FindHolder(const SphereTree& tree, const Sphere& sphere) : tree_(tree), sphere_(sphere) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    const Sphere around = tree_.sphere(static_cast<std::size_t>(node));
    return add_up(distance_upper(around.center, sphere_.center), sphere_.radius) <= around.radius;
  }
  bool leaf(std::int32_t) {
    found_ = true;
    return false;
  }
  bool found() const { return found_; }

 private:
  const SphereTree& tree_;
  const Sphere sphere_;
  bool found_ = false;
};

bool is_held(const SolidMesh& solid, const Sphere& sphere) {
  FindHolder query(solid.mesh().tree(), sphere);
  search_tree(solid.mesh().tree(), query);
  return query.found();
}

}  // namespace

std::vector<Sphere> spheres_around(const SolidMesh& solid) {
  std::vector<Sphere> spheres;
  double sum = 0.0;
  for (const Sphere& sphere : solid.mesh().tree().spheres()) {
    sum += sphere.radius;
    spheres.push_back({sphere.center, solid.inflation() > 0.0
                                          ? add_up(sphere.radius, solid.inflation())
                                          : sphere.radius});
  }
  if (!solid.has_inside()) return spheres;
  const Eigen::AlignedBox3d& box = solid.inside().box();
  // A little more than half of the longest side, for the rounding of cells.
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  std::vector<Cell> cells = {
      {0.5 * (box.min() + box.max()), 0.5 * box.sizes().maxCoeff() * (1.0 + 1e-9) + 1e-12 * reach}};
  const Sphere around = cells.front().sphere();
  const SphereTree frame = build_tree({&around, 1});
  const Pose same;  // kept by reference
  const RelativePose pose(frame, same, solid.mesh().tree(), same);
  const SpheresInside inside(frame, solid, pose);
  const double smallest = kSmallestCell * sum / static_cast<double>(spheres.size());
  const std::size_t most = std::max(kFewestCells, kCellsATriangle * spheres.size());
  for (int level = 0; !cells.empty(); ++level) {
    std::vector<Cell> at_surface;
    for (const Cell& cell : cells) {
      const Sphere sphere = cell.sphere();
      if (inside.is_outside_box(cell.center, sphere.radius)) continue;
      if (!inside.is_clear(cell.center, sphere.radius)) {
        if (!is_held(solid, sphere)) at_surface.push_back(cell);
      } else if (inside.contains(cell.center)) {
        spheres.push_back(sphere);
      }
    }
    // Of the eight parts of a cell at the surface four are there as well.
    const bool is_last = level == kMostLevels || 4 * at_surface.size() > most ||
                         (!at_surface.empty() && at_surface.front().sphere().radius <= smallest);
    cells.clear();
    for (const Cell& cell : at_surface) {
      if (is_last) {
        spheres.push_back(cell.sphere());
        continue;
      }
      for (int part = 0; part < 8; ++part) {
        const double quarter = 0.5 * cell.half;
        const Vector3d to((part & 1) == 0 ? -quarter : quarter,
                          (part & 2) == 0 ? -quarter : quarter,
                          (part & 4) == 0 ? -quarter : quarter);
        cells.push_back({cell.center + to, quarter * (1.0 + 1e-12)});
      }
    }
  }
  return spheres;
}

}  // namespace spherule::internal
