// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_distance.h"

#include "mesh/geometry/solid_angle.h"
#include "mesh/point_triangle.h"
#include "spheretree/median_split.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafSize = 4;

// Square of the distance from a point to a box: each difference and square rounded once, two sums,
// so a relative error below 6 u.
double squared_distance(const Vector3d& low, const Vector3d& high, const Vector3d& p) {
  const Vector3d d = (low - p).cwiseMax(p - high).cwiseMax(0.0);
  return d.squaredNorm();
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    corners_.push_back({vertex(0), vertex(1), vertex(2), static_cast<std::int32_t>(i)});
    for (int k = 0; k < 3; ++k) box_.extend(vertex(k));
  }
  nodes_.reserve(corners_.size());
  build(0, static_cast<std::int32_t>(corners_.size()));
}

void MeshDistance::build(std::int32_t begin, std::int32_t end) {
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centroids;
  const auto part = std::span(corners_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  for (const Corners& t : part) {
    box.extend(t.a).extend(t.b).extend(t.c);
    centroids.extend(Vector3d(t.a + t.b + t.c));
  }
  const std::size_t self = nodes_.size();
  nodes_.push_back({box.min(), box.max(), -1, begin, end});
  if (end - begin <= kLeafSize) return;
  const Eigen::Index axis = internal::longest_axis(centroids);
  const std::int32_t middle =
      begin + static_cast<std::int32_t>(internal::split_at_median(part, [axis](const Corners& t) {
        return std::pair(t.a[axis] + t.b[axis] + t.c[axis], t.triangle);
      }));
  build(begin, middle);
  nodes_[self].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

SurfaceDistance MeshDistance::operator()(const Vector3d& point, double limit) const {
  internal::require_content(!nodes_.empty(), "MeshDistance");
  SurfaceDistance best;
  best.lower = limit;
  double reach = limit;                                // nearest upper bound so far
  double reach_squared = reach * reach * kRelativeUp;  // boxes beyond it are no nearer
  std::array<std::pair<double, std::int32_t>, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = {squared_distance(nodes_[0].low, nodes_[0].high, point), 0};
  while (size > 0) {
    const auto [box_squared, index] = stack[--size];
    if (box_squared * kRelativeDown >= reach_squared) continue;
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.right < 0) {
      for (auto i = node.begin; i < node.end; ++i) {
        const Corners& t = corners_[static_cast<std::size_t>(i)];
        const Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c);
        const Vector3d high = t.a.cwiseMax(t.b).cwiseMax(t.c);
        if (squared_distance(low, high, point) * kRelativeDown >= reach_squared) continue;
        const TriangleDistance d = point_triangle_distance(point, t.a, t.b, t.c);
        best.lower = std::min(best.lower, d.lower);
        if (d.upper < reach) {
          reach = d.upper;
          reach_squared = reach * reach * kRelativeUp;
          best.upper = d.upper;
          best.closest = d.closest;
          best.triangle = t.triangle;
        }
      }
      continue;
    }
    const std::int32_t left = index + 1;
    const auto child = [&](std::int32_t i) {
      const Node& n = nodes_[static_cast<std::size_t>(i)];
      return std::pair{squared_distance(n.low, n.high, point), i};
    };
    auto near = child(left);
    auto far = child(node.right);
    if (far.first < near.first) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return best;
}

// Where the ray is between the planes of the box: each quotient errs by 2 u of itself, and so do
// the least and the greatest of them.
bool MeshDistance::may_intersect(const Node& node, const Vector3d& point,
                                 const Vector3d& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (node.low[axis] - point[axis]) / direction[axis];
    const double high = (node.high[axis] - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  constexpr double kSlack = 8.0 * kUnitRoundoff;
  return leave >= 0.0 && enter - kSlack * std::abs(enter) <= leave + kSlack * leave;
}

double MeshDistance::winding_number(const Vector3d& point) const {
  internal::require_content(!nodes_.empty(), "MeshDistance");
  double angle = 0.0;
  for (const Corners& t : corners_) {
    angle += internal::solid_angle(t.a - point, t.b - point, t.c - point);
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace spherule
