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

// At least the square, and by more than a box's squared distance errs by; never 0.
double squared_up(double x) {
  return x * x * kRelativeUp + 0x1p-1060;
}

// Square of the distance from a point to a box: each difference and square rounded once, two sums,
// so a relative error below 6 u.
double squared_distance(const Vector3d& low, const Vector3d& high, const Vector3d& p) {
  const Vector3d d = (low - p).cwiseMax(p - high).cwiseMax(0.0);
  return d.squaredNorm();
}

// The same of two boxes, a row each.
template <class Corners>
Eigen::Array2d squared_distances(const Corners& low, const Corners& high, const Vector3d& p) {
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Array2d d =
        (low.col(axis) - p[axis]).max(p[axis] - high.col(axis)).max(Eigen::Array2d::Zero());
    sum += d * d;
  }
  return sum;
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[i]);
    corners_.push_back({a, b, c, static_cast<std::int32_t>(i)});
    box_.extend(a).extend(b).extend(c);
  }
  nodes_.reserve(corners_.size() / kLeafSize);
  root_ = build(0, static_cast<std::int32_t>(corners_.size())).first;
}

std::pair<std::int32_t, Eigen::AlignedBox3d> MeshDistance::build(std::int32_t begin,
                                                                 std::int32_t end) {
  const auto part = std::span(corners_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  if (end - begin <= kLeafSize) {
    Eigen::AlignedBox3d box;
    for (const Corners& t : part) box.extend(t.a).extend(t.b).extend(t.c);
    leaves_.push_back({begin, end});
    return {~static_cast<std::int32_t>(leaves_.size() - 1), box};
  }
  Eigen::AlignedBox3d centroids;
  for (const Corners& t : part) centroids.extend(Vector3d(t.a + t.b + t.c));
  const Eigen::Index axis = internal::longest_axis(centroids);
  const std::int32_t middle =
      begin + static_cast<std::int32_t>(internal::split_at_median(part, [axis](const Corners& t) {
        return std::pair(t.a[axis] + t.b[axis] + t.c[axis], t.triangle);
      }));
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  const auto left = build(begin, middle);
  const auto right = build(middle, end);
  Node& node = nodes_[self];
  node.children = {left.first, right.first};
  node.low << left.second.min().transpose(), right.second.min().transpose();
  node.high << left.second.max().transpose(), right.second.max().transpose();
  return {static_cast<std::int32_t>(self), left.second.merged(right.second)};
}

SurfaceDistance MeshDistance::operator()(const Vector3d& point, double limit,
                                         std::size_t most_leaves) const {
  internal::require_content(!leaves_.empty(), "MeshDistance");
  SurfaceDistance best;
  best.lower = limit;
  double reach = limit;                      // nearest upper bound so far
  double reach_squared = squared_up(reach);  // boxes beyond it are no nearer
  const auto is_beyond = [&](double squared) { return squared * kRelativeDown >= reach_squared; };
  std::array<std::pair<double, std::int32_t>, kStackSize> waiting;
  std::size_t size = 0;
  for (std::int32_t child = root_;;) {
    if (child < 0) {
      if (most_leaves-- == 0) {
        best.lower = 0.0;
        return best;
      }
      const Leaf& leaf = leaves_[static_cast<std::size_t>(~child)];
      for (auto i = leaf.begin; i < leaf.end; ++i) {
        const Corners& t = corners_[static_cast<std::size_t>(i)];
        const Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c);
        const Vector3d high = t.a.cwiseMax(t.b).cwiseMax(t.c);
        if (is_beyond(squared_distance(low, high, point))) continue;
        const TriangleDistance d = point_triangle_distance(point, t.a, t.b, t.c);
        best.lower = std::min(best.lower, d.lower);
        if (d.upper < reach) {
          reach = d.upper;
          reach_squared = squared_up(reach);
          best.upper = d.upper;
          best.closest = d.closest;
          best.triangle = t.triangle;
        }
      }
    } else {
      const Node& node = nodes_[static_cast<std::size_t>(child)];
      const Eigen::Array2d squared = squared_distances(node.low, node.high, point);
      std::pair near(squared[0], node.children[0]);
      std::pair far(squared[1], node.children[1]);
      if (far.first < near.first) std::swap(near, far);
      if (!is_beyond(near.first)) {
        if (!is_beyond(far.first)) waiting[size++] = far;
        child = near.second;
        continue;
      }
    }
    while (size > 0 && is_beyond(waiting[size - 1].first)) --size;
    if (size == 0) return best;
    child = waiting[--size].second;
  }
}

// Where the ray is between the planes of the box: each quotient errs by 2 u of itself, and so do
// the least and the greatest of them.
bool MeshDistance::may_intersect(const Eigen::Array3d& low_corner,
                                 const Eigen::Array3d& high_corner, const Vector3d& point,
                                 const Vector3d& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (low_corner[axis] - point[axis]) / direction[axis];
    const double high = (high_corner[axis] - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  constexpr double kSlack = 8.0 * kUnitRoundoff;
  return leave >= 0.0 && enter - kSlack * std::abs(enter) <= leave + kSlack * leave;
}

double MeshDistance::winding_number(const Vector3d& point) const {
  internal::require_content(!leaves_.empty(), "MeshDistance");
  double angle = 0.0;
  for (const Corners& t : corners_) {
    angle += internal::solid_angle(t.a - point, t.b - point, t.c - point);
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace spherule
