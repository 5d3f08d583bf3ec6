// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/solids.h"

#include "base/error.h"
#include "tests/support/turn_between.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

namespace spherule {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;

// Two triangles for the corners a, b, c, d in order around an outward face.
void add_quad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.emplace_back(a, b, c);
  mesh.triangles.emplace_back(a, c, d);
}

std::size_t index(int value) {
  return static_cast<std::size_t>(value);
}

// Splits edges of a closed mesh; knows the triangle to the left of every directed edge.
class EdgeSplitter {
 public:
  explicit EdgeSplitter(TriangleMesh& mesh) : mesh_(mesh) {
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) enter(t);
  }

  void split_longest() {
    for (;;) {
      const auto [length, minus_from, minus_to] = queue_.top();
      queue_.pop();
      const auto left = left_of_.extract({-minus_from, -minus_to});
      const auto right = left_of_.extract({-minus_to, -minus_from});
      if (left.empty() && right.empty()) continue;  // split before
      if (left.empty() || right.empty()) throw Error("mesh", "an open surface cannot be refined");
      const int middle = static_cast<int>(mesh_.vertices.size());
      mesh_.vertices.push_back(0.5 * (vertex(-minus_from) + vertex(-minus_to)));
      split(left.mapped(), left.key(), middle);
      split(right.mapped(), right.key(), middle);
      return;
    }
  }

 private:
  using Edge = std::pair<int, int>;
  // Longest first; of equal ones the edge with the smallest indices, which stands in the queue from
  // its smaller index, perhaps twice.
  using Entry = std::tuple<double, int, int>;

  const Vector3d& vertex(int v) const { return mesh_.vertices[index(v)]; }

  void enter(int triangle) {
    const Vector3i& corners = mesh_.triangles[index(triangle)];
    for (int i = 0; i < 3; ++i) {
      const Edge edge{corners[i], corners[(i + 1) % 3]};
      left_of_[edge] = triangle;
      const auto [small, large] = std::minmax(edge.first, edge.second);
      queue_.emplace((vertex(small) - vertex(large)).squaredNorm(), -small, -large);
    }
  }

  void split(int triangle, Edge edge, int middle) {
    Vector3i& corners = mesh_.triangles[index(triangle)];
    const int opposite = corners.sum() - edge.first - edge.second;
    corners = {edge.first, middle, opposite};
    mesh_.triangles.emplace_back(middle, edge.second, opposite);
    enter(triangle);
    enter(static_cast<int>(mesh_.triangles.size()) - 1);
  }

  TriangleMesh& mesh_;
  std::map<Edge, int> left_of_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

TriangleMesh extrude(const Loop& outer, const std::vector<Loop>& holes, double bottom, double top) {
  TriangleMesh mesh;
  std::vector<std::pair<Loop, bool>> loops{{outer, false}};
  for (const Loop& hole : holes) loops.emplace_back(hole, true);
  for (const auto& [loop, is_hole] : loops) {
    for (const Vector2d& p : loop) mesh.vertices.emplace_back(p.x(), p.y(), bottom);
  }
  const int layer = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < layer; ++i) {
    const Vector3d low = mesh.vertices[index(i)];
    mesh.vertices.emplace_back(low.x(), low.y(), top);
  }
  for (const Vector3i& t : triangulate(outer, holes)) {
    mesh.triangles.emplace_back(t[0] + layer, t[1] + layer, t[2] + layer);
    mesh.triangles.emplace_back(t[0], t[2], t[1]);
  }
  int first = 0;
  for (const auto& [loop, is_hole] : loops) {
    const int n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      int a = first + i;
      int b = first + (i + 1) % n;
      if (is_hole) std::swap(a, b);
      add_quad(mesh, a, b, b + layer, a + layer);
    }
    first += n;
  }
  return mesh;
}

TriangleMesh revolve(const Loop& profile, int sides) {
  TriangleMesh mesh;
  std::vector<int> first;  // vertex of every corner of the profile at the first side
  for (const Vector2d& p : profile) {
    first.push_back(static_cast<int>(mesh.vertices.size()));
    const int copies = p.x() == 0.0 ? 1 : sides;
    for (int s = 0; s < copies; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sides;
      mesh.vertices.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
    }
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::size_t j = (i + 1) % profile.size();
    const bool on_axis_i = profile[i].x() == 0.0;
    const bool on_axis_j = profile[j].x() == 0.0;
    for (int s = 0; s < sides && !(on_axis_i && on_axis_j); ++s) {
      const int next = (s + 1) % sides;
      if (on_axis_i) {
        mesh.triangles.emplace_back(first[i], first[j] + next, first[j] + s);
      } else if (on_axis_j) {
        mesh.triangles.emplace_back(first[i] + s, first[i] + next, first[j]);
      } else {
        add_quad(mesh, first[i] + s, first[i] + next, first[j] + next, first[j] + s);
      }
    }
  }
  return mesh;
}

Eigen::Quaterniond turn_between(const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from.normalized();
  const Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (cosine < -1.0 + 1e-12) {
    turn.w() = 0.0;
    turn.vec() = a.unitOrthogonal();
    return turn;
  }
  const double twice_w = std::sqrt((1.0 + cosine) * 2.0);
  turn.w() = twice_w * 0.5;
  turn.vec() = a.cross(b) * (1.0 / twice_w);
  return turn;
}

TriangleMesh tube_along(std::span<const Vector3d> path, std::span<const double> radii, int sides) {
  TriangleMesh mesh;
  const std::size_t points = path.size();
  const auto direction = [&](std::size_t i) {
    const Vector3d& before = path[i == 0 ? 0 : i - 1];
    const Vector3d& after = path[i + 1 == points ? i : i + 1];
    return Vector3d((after - before).normalized());
  };
  Vector3d tangent = direction(0);
  Vector3d side = tangent.unitOrthogonal();
  for (std::size_t i = 0; i < points; ++i) {
    // Carried along by the smallest rotation between neighbours, so that the tube does not twist.
    const Vector3d next = direction(i);
    side = turn_between(tangent, next) * side;
    tangent = next;
    const Vector3d across = tangent.cross(side);
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sides;
      mesh.vertices.push_back(path[i] +
                              radii[i] * (std::cos(angle) * side + std::sin(angle) * across));
    }
  }
  for (int ring = 0; ring + 1 < static_cast<int>(points); ++ring) {
    for (int s = 0; s < sides; ++s) {
      const int a = ring * sides + s;
      const int b = ring * sides + (s + 1) % sides;
      add_quad(mesh, a, b, b + sides, a + sides);
    }
  }
  const int start = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(path.front());
  mesh.vertices.push_back(path.back());
  const int last_ring = (static_cast<int>(points) - 1) * sides;
  for (int s = 0; s < sides; ++s) {
    const int next = (s + 1) % sides;
    mesh.triangles.emplace_back(start, next, s);
    mesh.triangles.emplace_back(start + 1, last_ring + s, last_ring + next);
  }
  return mesh;
}

Matrix3d profile_xz() {
  return (Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
}

Matrix3d along_x() {
  return (Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
}

Matrix3d along_y() {
  return (Matrix3d() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished();
}

TriangleMesh placed(TriangleMesh mesh, const Matrix3d& turn, const Vector3d& shift) {
  for (Vector3d& vertex : mesh.vertices) vertex = turn * vertex + shift;
  return mesh;
}

TriangleMesh shifted(TriangleMesh mesh, const Vector3d& shift) {
  return placed(std::move(mesh), Matrix3d::Identity(), shift);
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const Vector3i offset = Vector3i::Constant(static_cast<int>(mesh.vertices.size()));
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Vector3i& triangle : other.triangles) mesh.triangles.push_back(triangle + offset);
}

void refine_to(TriangleMesh& mesh, std::size_t count) {
  const std::size_t start = mesh.triangles.size();
  if (start > count || (count - start) % 2 != 0) {
    throw Error("mesh", "has " + std::to_string(start) + " triangles and cannot be refined to " +
                            std::to_string(count));
  }
  EdgeSplitter splitter(mesh);
  while (mesh.triangles.size() < count) splitter.split_longest();
}

void snap(TriangleMesh& mesh) {
  for (Vector3d& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) vertex[i] = std::nearbyint(vertex[i] * 0x1p22) * 0x1p-22;
  }
}

}  // namespace spherule
