// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_inside.h"

#include "base/rounding.h"
#include "collide/meshes/spheres_inside.h"
#include "collide/search/traversal.h"
#include "geometry/point_triangle.h"
#include "geometry/ray.h"
#include "geometry/shells.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// The corners of every triangle, numbered so that equal positions have equal numbers.
std::vector<std::array<int, 3>> corners_by_position(const TriangleMesh& mesh) {
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto position = [&](int v) {
    const Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return position(a) < position(b); });
  std::vector<int> name(mesh.vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && position(order[i]) == position(order[i - 1]);
    name[static_cast<std::size_t>(order[i])] =
        same ? name[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  std::vector<std::array<int, 3>> result;
  result.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return name[static_cast<std::size_t>(t[k])]; };
    result.push_back({corner(0), corner(1), corner(2)});
  }
  return result;
}

// The winding numbers of the closed surfaces that a ray intersects, as far as there is room: of
// those with the lowest numbers from `first` on.
class WindingNumbers {
 public:
  explicit WindingNumbers(std::int32_t first) : first_(first) {}

  void add(std::int32_t surface, int crossing) {
    if (surface < first_ || surface >= end_) return;
    const auto known = entries_.begin() + static_cast<std::ptrdiff_t>(size_);
    const auto entry =
        std::find_if(entries_.begin(), known, [&](const Entry& e) { return e.surface == surface; });
    if (entry != known) {
      entry->sum += crossing;
    } else if (size_ < entries_.size()) {
      entries_[size_++] = {surface, crossing};
    } else {
      const auto last =
          std::max_element(entries_.begin(), known,
                           [](const Entry& a, const Entry& b) { return a.surface < b.surface; });
      end_ = std::max(surface, last->surface);
      if (surface < last->surface) *last = {surface, crossing};
    }
  }
  bool any() const {
    return std::any_of(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(size_),
                       [](const Entry& e) { return e.sum != 0; });
  }
  // Which surface is the first that had no room; the largest number if all had.
  std::int32_t end() const { return end_; }

 private:
  struct Entry {
    std::int32_t surface;
    int sum;
  };

  std::array<Entry, 64> entries_;
  std::size_t size_ = 0;
  std::int32_t first_;
  std::int32_t end_ = std::numeric_limits<std::int32_t>::max();
};

// Adds the crossings of the ray; false if it cannot tell.
bool count_crossings(const MeshTree& mesh, const std::vector<TriangleRole>& roles, const Ray& ray,
                     WindingNumbers& numbers) {
  // build_tree makes no more than 3 * 30 + 9 levels of 8 children, and each level leaves at most 7
  // of them waiting.
  std::array<std::int32_t, 99 * 7 + 1> stack;
  const SphereTree& tree = mesh.tree();
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const auto node = static_cast<std::size_t>(stack[--top]);
    if (!ray.may_intersect(tree.sphere(node))) continue;
    if (!tree.is_leaf(node)) {
      assert(top + static_cast<std::size_t>(tree.child_count(node)) <= stack.size());
      for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
        stack[top++] = tree.first_child(node) + i;
      }
      continue;
    }
    const std::int32_t index = tree.sphere_index(node);
    const TriangleRole& role = roles[static_cast<std::size_t>(index)];
    if (!role.counts()) continue;
    const std::optional<int> crossing = ray.crossing(mesh.triangle(index));
    if (!crossing) return false;
    if (*crossing == 0) continue;
    numbers.add(role.shell, *crossing);
    numbers.add(role.patch, *crossing * role.turn);
    numbers.add(role.front, *crossing);
    numbers.add(role.back, -*crossing);
  }
  return true;
}

// Whether a winding number is not zero, if this ray can tell.
std::optional<bool> winds(const MeshTree& mesh, const std::vector<TriangleRole>& roles,
                          const Ray& ray) {
  std::int32_t next = 0;
  while (next < std::numeric_limits<std::int32_t>::max()) {
    WindingNumbers numbers(next);
    if (!count_crossings(mesh, roles, ray, numbers)) return std::nullopt;
    if (numbers.any()) return true;
    next = numbers.end();
  }
  return false;
}

}  // namespace

std::vector<Vector3d> component_points(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> triangles = corners_by_position(mesh);
  OrientedDisjointSets components(mesh.vertices.size());
  for (const std::array<int, 3>& t : triangles) {
    components.join(t[0], t[1]);
    components.join(t[1], t[2]);
  }
  Eigen::AlignedBox3d around;
  for (const Vector3d& vertex : mesh.vertices) around.extend(vertex);
  const Vector3d middle = around.center();
  std::vector<int> point_of(mesh.vertices.size(), -1);
  std::vector<Vector3d> points;
  for (const std::array<int, 3>& t : triangles) {
    const auto component = static_cast<std::size_t>(components.find(t[0]).root);
    if (point_of[component] < 0) {
      point_of[component] = static_cast<int>(points.size());
      points.push_back(mesh.vertices[static_cast<std::size_t>(t[0])]);
    }
    Vector3d& point = points[static_cast<std::size_t>(point_of[component])];
    for (const int corner : t) {
      const Vector3d& vertex = mesh.vertices[static_cast<std::size_t>(corner)];
      if ((vertex - middle).squaredNorm() > (point - middle).squaredNorm()) point = vertex;
    }
  }
  return points;
}

MeshInside::MeshInside(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> triangles = corners_by_position(mesh);
  MeshShells shells = find_shells(triangles, mesh.vertices);
  is_closed_ = shells.are_closed;
  roles_ = std::move(shells.roles);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!roles_[i].counts()) continue;
    has_inside_ = true;
    for (const int corner : triangles[i]) {
      box_.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
  }
}

std::optional<bool> MeshInside::find(const MeshTree& tree, const Vector3d& point,
                                     double error) const {
  if (!has_inside_) return false;
  for (int k = 0; k < 3; ++k) {
    if (point[k] < sub_down(box_.min()[k], error) || point[k] > add_up(box_.max()[k], error)) {
      return false;
    }
  }
  for (const Vector3d& direction : kRayDirections) {
    const std::optional<bool> found = winds(tree, roles_, Ray(point, error, direction));
    if (found) return found;
  }
  return std::nullopt;
}

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
