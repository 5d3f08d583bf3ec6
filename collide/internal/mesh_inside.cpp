// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/mesh_inside.h"

#include "collide/internal/ray.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <optional>
#include <tuple>

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

// Which vertex stands for the component of a vertex.
class Components {
 public:
  explicit Components(std::size_t count) : up_(count) { std::iota(up_.begin(), up_.end(), 0); }

  int find(int v) {
    while (up(v) != v) {
      up(v) = up(up(v));
      v = up(v);
    }
    return v;
  }
  void join(int a, int b) { up(find(a)) = find(b); }

 private:
  int& up(int v) { return up_[static_cast<std::size_t>(v)]; }

  std::vector<int> up_;
};

struct Edge {
  int low, high;  // corners
  int turn;       // +1 from low to high, -1 back
};

// Of every vertex that stands for a component: 1 if the triangles pass each edge as often in both
// directions.
std::vector<char> closed_components(const std::vector<std::array<int, 3>>& triangles,
                                    Components& components, std::size_t vertices) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::array<int, 3>& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      if (from < to) edges.push_back({from, to, 1});
      if (to < from) edges.push_back({to, from, -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  std::vector<char> closed(vertices, 1);
  for (std::size_t i = 0; i < edges.size();) {
    const Edge& edge = edges[i];
    int surplus = 0;
    for (; i < edges.size() && edges[i].low == edge.low && edges[i].high == edge.high; ++i) {
      surplus += edges[i].turn;
    }
    if (surplus != 0) closed[static_cast<std::size_t>(components.find(edge.low))] = 0;
  }
  return closed;
}

// The winding number, if this ray can tell.
std::optional<int> crossings(const MeshTree& mesh, const std::vector<char>& counts,
                             const Ray& ray) {
  // build_tree makes no more than 3 * 30 + 9 levels of 8 children, and each level leaves at most 7
  // of them waiting.
  std::array<std::int32_t, 99 * 7 + 1> stack;
  const SphereTree& tree = mesh.tree();
  std::size_t top = 0;
  stack[top++] = 0;
  int sum = 0;
  while (top > 0) {
    const auto node = static_cast<std::size_t>(stack[--top]);
    if (!ray.may_meet(tree.ball(node))) continue;
    if (!tree.is_leaf(node)) {
      assert(top + static_cast<std::size_t>(tree.child_count(node)) <= stack.size());
      for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
        stack[top++] = tree.first_child(node) + i;
      }
      continue;
    }
    const std::int32_t index = tree.sphere_index(node);
    if (counts[static_cast<std::size_t>(index)] == 0) continue;
    const std::optional<int> crossing = ray.crossing(mesh.triangle(index));
    if (!crossing) return std::nullopt;
    sum += *crossing;
  }
  return sum;
}

}  // namespace

MeshInside::MeshInside(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> triangles = corners_by_position(mesh);
  Components components(mesh.vertices.size());
  for (const std::array<int, 3>& t : triangles) {
    components.join(t[0], t[1]);
    components.join(t[1], t[2]);
  }
  const std::vector<char> closed = closed_components(triangles, components, mesh.vertices.size());
  Eigen::AlignedBox3d around;
  for (const Vector3d& vertex : mesh.vertices) around.extend(vertex);
  const Vector3d middle = around.center();
  std::vector<int> point_of(mesh.vertices.size(), -1);
  is_solid_.reserve(triangles.size());
  for (const std::array<int, 3>& t : triangles) {
    const auto component = static_cast<std::size_t>(components.find(t[0]));
    const bool solid = closed[component] != 0;
    is_solid_.push_back(solid ? 1 : 0);
    has_inside_ = has_inside_ || solid;
    is_closed_ = is_closed_ && solid;
    if (point_of[component] < 0) {
      point_of[component] = static_cast<int>(points_.size());
      points_.push_back(mesh.vertices[static_cast<std::size_t>(t[0])]);
    }
    Vector3d& point = points_[static_cast<std::size_t>(point_of[component])];
    for (const int corner : t) {
      const Vector3d& vertex = mesh.vertices[static_cast<std::size_t>(corner)];
      if ((vertex - middle).squaredNorm() > (point - middle).squaredNorm()) point = vertex;
      if (solid) box_.extend(vertex);
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
    const std::optional<int> winding = crossings(tree, is_solid_, Ray(point, error, direction));
    if (winding) return *winding != 0;
  }
  return std::nullopt;
}

}  // namespace spherule::internal
