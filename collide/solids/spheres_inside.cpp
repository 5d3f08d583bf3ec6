// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/spheres_inside.h"

#include "collide/search/one_tree.h"
#include "collide/solids/mesh_inside.h"
#include "mesh/point_triangle.h"

#include <algorithm>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Whether a triangle comes within a reach of a point.
class FindTriangle {
 public:
  FindTriangle(const MeshTree& mesh, const Vector3d& point, double reach)
      : mesh_(mesh), point_(point), reach_(reach) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    const Sphere sphere = mesh_.tree().sphere(static_cast<std::size_t>(node));
    const double limit = sphere.radius + reach_;
    return (sphere.center - point_).squaredNorm() <= limit * limit;
  }
  bool leaf(std::int32_t node) {
    const auto& [a, b, c] =
        mesh_.triangle(mesh_.tree().sphere_index(static_cast<std::size_t>(node)));
    found_ = point_triangle_distance(point_, a, b, c).lower <= reach_;
    return !found_;
  }
  bool found() const { return found_; }

 private:
  const MeshTree& mesh_;
  const Vector3d point_;
  const double reach_;
  bool found_ = false;
};

// Ends at the first sphere that is inside. Remembers the last few spheres that were found to be
// outside: the next sphere most often overlaps one of them.
class FindInside {
 public:
  FindInside(const SphereTree& tree, const SpheresInside& spheres)
      : tree_(tree), spheres_(spheres) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) {
    const auto index = static_cast<std::size_t>(node);
    const Sphere sphere = tree_.sphere(index);
    const Vector3d center = spheres_.in_mesh(sphere.center);
    if (spheres_.is_outside_box(center, sphere.radius)) return false;
    if (tree_.is_leaf(index) || !spheres_.is_clear(center, sphere.radius)) return true;
    if (spheres_.contains(center)) return true;
    remember(sphere);
    return false;
  }
  bool leaf(std::int32_t node) {
    const auto index = static_cast<std::size_t>(node);
    const Sphere sphere = tree_.sphere(index);
    if (overlaps_outside(sphere)) return true;
    if (spheres_.contains(spheres_.in_mesh(sphere.center))) {
      inside_ = tree_.sphere_index(index);
      return false;
    }
    remember(sphere);
    return true;
  }
  std::int32_t inside() const { return inside_; }

 private:
  bool overlaps_outside(const Sphere& sphere) const {
    return std::any_of(outside_.begin(), outside_.begin() + static_cast<std::ptrdiff_t>(known_),
                       [&](const Sphere& other) {
                         return distance_upper(other.center, sphere.center) <=
                                next_down(other.radius + sphere.radius);
                       });
  }
  void remember(const Sphere& sphere) {
    outside_[next_] = sphere;
    next_ = (next_ + 1) % outside_.size();
    known_ = std::min(known_ + 1, outside_.size());
  }

  const SphereTree& tree_;
  const SpheresInside& spheres_;
  std::array<Sphere, 16> outside_;
  std::size_t next_ = 0;
  std::size_t known_ = 0;
  std::int32_t inside_ = -1;
};

}  // namespace

SpheresInside::SpheresInside(const SphereTree& tree, const SolidMesh& solid,
                             const RelativePose& pose)
    : tree_(tree),
      solid_(solid),
      mesh_from_tree_(pose.b_from_a()),
      error_(144.0 * kUnitRoundoff * pose.node_size() + kUnderflow),
      pad_(160.0 * kUnitRoundoff * pose.node_size() + 8.0 * kUnderflow) {}

bool SpheresInside::contains(const Vector3d& in_mesh) const {
  return solid_.inside().contains(solid_.mesh(), in_mesh, error_);
}

bool SpheresInside::certainly_contains(const Vector3d& in_mesh) const {
  return solid_.inside().find(solid_.mesh(), in_mesh, error_).value_or(false);
}

bool SpheresInside::is_outside_box(const Vector3d& in_mesh, double radius) const {
  const Eigen::AlignedBox3d& box = solid_.inside().box();
  const double reach = radius + pad_;
  for (int k = 0; k < 3; ++k) {
    if (in_mesh[k] + reach < box.min()[k] || in_mesh[k] - reach > box.max()[k]) return true;
  }
  return false;
}

bool SpheresInside::is_clear(const Vector3d& in_mesh, double radius) const {
  FindTriangle query(solid_.mesh(), in_mesh, radius + pad_);
  search_tree(solid_.mesh().tree(), query);
  return !query.found();
}

std::int32_t SpheresInside::find() const {
  if (!solid_.has_inside()) return -1;
  FindInside query(tree_, *this);
  search_tree(tree_, query);
  return query.inside();
}

}  // namespace spherule::internal
