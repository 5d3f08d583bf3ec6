// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/mesh_facts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// Of every vertex, the first one of its component.
std::vector<int> component_leaders(const TriangleMesh& mesh) {
  std::vector<int> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[static_cast<std::size_t>(v)] != v) {
      int& up = root[static_cast<std::size_t>(v)];
      up = root[static_cast<std::size_t>(up)];
      v = up;
    }
    return v;
  };
  for (const Vector3i& t : mesh.triangles) {
    for (int i = 1; i < 3; ++i) {
      // The smaller index leads, so that a component is named by its first vertex.
      const auto [small, large] = std::minmax({find(t[0]), find(t[i])});
      root[static_cast<std::size_t>(large)] = small;
    }
  }
  for (std::size_t v = 0; v < root.size(); ++v) root[v] = find(static_cast<int>(v));
  return root;
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> surplus;  // of each edge, from its smaller index
  for (const Vector3i& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int from = t[i];
      const int to = t[(i + 1) % 3];
      if (from != to) surplus[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(surplus.begin(), surplus.end(),
                     [](const auto& entry) { return entry.second == 0; });
}

double signed_volume(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

std::vector<Vector3d> component_points(const TriangleMesh& mesh) {
  std::vector<Vector3d> points;
  for (const TriangleMesh& part : components(mesh)) points.push_back(part.vertices.front());
  return points;
}

std::vector<TriangleMesh> components(const TriangleMesh& mesh) {
  const std::vector<int> leaders = component_leaders(mesh);
  std::vector<TriangleMesh> parts;
  std::vector<int> part_of(mesh.vertices.size(), -1), moved_to(mesh.vertices.size(), -1);
  for (const Vector3i& t : mesh.triangles) {
    int& index = part_of[static_cast<std::size_t>(leaders[static_cast<std::size_t>(t[0])])];
    if (index < 0) {
      index = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    TriangleMesh& part = parts[static_cast<std::size_t>(index)];
    for (const int v : t) {
      int& to = moved_to[static_cast<std::size_t>(v)];
      if (to >= 0) continue;
      to = static_cast<int>(part.vertices.size());
      part.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    }
    const auto corner = [&](int k) { return moved_to[static_cast<std::size_t>(t[k])]; };
    part.triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  return parts;
}

double winding_number(const TriangleMesh& mesh, const Vector3d& point) {
  double angle = 0.0;
  for (const Vector3i& t : mesh.triangles) {
    auto [a, b, c] = corners_of(mesh, t);
    for (Vector3d* corner : {&a, &b, &c}) *corner -= point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (2.0 * std::numbers::pi);
}

}  // namespace spherule
